/** The presentation: the stage alone with large captions. It belongs to this tab, and its link. And the whole screen. */

import { byId } from "pinik/elements.js";

export class Presentation {
    /** @param onChange called with whether the page presents, after every change */
    constructor(onChange) {
        this._onChange = onChange;
        byId("present").addEventListener("click", () => this.turn());
        byId("whole-screen").addEventListener("click", () => this.turnWholeScreen());
        byId("whole-screen").hidden = !document.fullscreenEnabled;
        document.addEventListener("keydown", ({ key }) => {
            if (key === "Escape" && !document.querySelector("dialog[open]")) this.turn(false);
        });
        document.addEventListener("fullscreenchange", () => {
            byId("whole-screen").ariaPressed = String(Boolean(document.fullscreenElement));
        });
        this.on = false;
    }

    turn(on = !this.on) {
        if (on === this.on) return;
        this.on = on;
        document.documentElement.classList.toggle("presenting", on);
        byId("present").ariaPressed = String(on);
        byId("present").title = on ? "Show the panel again (h)" : "Present: the stage alone, with large captions (h)";
        this._onChange(on);
    }

    turnWholeScreen() {
        if (document.fullscreenElement) document.exitFullscreen();
        else if (document.fullscreenEnabled) document.documentElement.requestFullscreen();
    }
}
