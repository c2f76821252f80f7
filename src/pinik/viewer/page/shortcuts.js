/** What each key of the live page does. */

import { PRESETS } from "pinik/camera.js";
import { byId } from "pinik/elements.js";

/** The bindings for `Keys`, on a page's parts. */
export function shortcuts(page) {
    const { controls, show, targets } = page;
    const next = (list, now) => list[(list.indexOf(now) + 1) % list.length];
    const names = (list) => list.map(({ name }) => name);
    const send = (type, fields) => page.connection.send({ type, ...fields });
    const nudge = (event) => page.nudge.press(event.key, targets.selected, event.shiftKey);
    return [
        { keys: [" "], shown: ["Space"], title: "start or stop", act: () => controls.toggleRun() },
        { keys: ["."], title: "one step", act: () => controls.step() },
        { keys: ["r"], title: "reset", act: () => send("reset") },
        { keys: ["1", "2", "4"], title: "so many robots side by side", act: ({ key }) => controls.view(Number(key)) },
        {
            keys: ["m"],
            title: "by hand, along a curve, at random",
            act: () => send("motion", { motion: next(names(page.hello.motions), page.state.motion) }),
        },
        {
            keys: ["c"],
            title: "next curve",
            act: () => send("curve", { curve: next(names(page.hello.curves), page.state.curve) }),
        },
        {
            keys: ["+", "=", "-"],
            shown: ["+", "−"],
            title: "faster, slower",
            act: ({ key }) => controls.changeSpeed(key === "-" ? 0.8 : 1.25),
        },
        { keys: ["l"], title: "joint limits on or off", act: () => send("limits", { on: !page.state.limits }) },
        { keys: ["p"], title: "parameters of the next method", act: () => page.cards.openNext() },
        { keys: ["b"], title: "select the next ball", act: () => targets.selectNext() },
        {
            keys: ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"],
            shown: ["←", "→", "↑", "↓"],
            title: "ball sideways, away and nearer; Shift: finer",
            act: nudge,
        },
        { keys: ["PageUp", "PageDown"], shown: ["Page ↑", "Page ↓"], title: "ball up, down; Shift: finer", act: nudge },
        { keys: ["o"], title: "ask for an orientation too", act: () => targets.toggleOrientation() },
        {
            keys: ["v"],
            title: "next side to look from",
            act: () => show.frameAll(true, next(Object.keys(PRESETS), show.camera.preset)),
        },
        { keys: ["f"], title: "look at everything", act: () => show.frameAll() },
        { keys: ["t"], title: "light, dark or the system's theme", act: () => page.theme.turn() },
        { keys: ["?"], title: "this list", act: () => byId("help").showModal() },
    ];
}
