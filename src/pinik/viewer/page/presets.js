/** The buttons of the camera presets. */

import { PRESETS } from "pinik/camera.js";
import { make } from "pinik/elements.js";

export function addPresets(element, show) {
    for (const [name, { title }] of Object.entries(PRESETS)) {
        const button = make("button", { type: "button", dataset: { testid: `camera-${name}`, preset: name } }, title);
        button.addEventListener("click", () => show.frameAll(true, name));
        element.append(button);
    }
    const mark = () => {
        for (const button of element.children) {
            button.ariaPressed = String(button.dataset.preset === show.camera.preset && !show.camera.moved);
        }
    };
    show.camera.addEventListener("framed", mark);
    show.camera.addEventListener("taken", mark);
}
