/** The switch that says whether the rings turn a ball about its own axes or the world's. */

import { byId } from "pinik/elements.js";

const CHOICES = ["local", "world"];

export class RingAxes {
    /** @param onChange called with "local" or "world" */
    constructor(onChange) {
        this._onChange = onChange;
        this.choice = CHOICES[0];
        for (const choice of CHOICES) byId(`ring-${choice}`).addEventListener("click", () => this.choose(choice));
    }

    choose(choice) {
        if (choice === this.choice) return;
        this.choice = choice;
        for (const each of CHOICES) byId(`ring-${each}`).ariaPressed = String(each === choice);
        this._onChange(choice);
    }
}
