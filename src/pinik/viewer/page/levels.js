/** How many of a method's parameters a card shows: the one that matters, more, or all. */

import { make } from "pinik/elements.js";

const LEVELS = [
    [1, "main", "Main", "The parameter that matters most"],
    [2, "more", "More", "Those worth trying"],
    [3, "all", "All", "Every parameter"],
];

export class Levels {
    /** @param onChange called when another level is chosen */
    constructor(index, onChange) {
        this._chosen = 1;
        this._least = 1;
        this._buttons = LEVELS.map(([level, name, words, title]) => {
            const dataset = { testid: `level-${index}-${name}` };
            const button = make("button", { type: "button", title, dataset }, words);
            button.addEventListener("click", () => {
                this._chosen = level;
                onChange();
            });
            return button;
        });
        this.element = make(
            "div",
            { className: "segments levels", role: "group", aria: { label: "Which parameters" } },
            ...this._buttons,
        );
    }

    /** Offer the levels of these parameters, in which some level may have none. */
    offer(parameters) {
        const levels = new Set(parameters.map(({ level }) => level));
        this._least = Math.min(...levels, 3);
        this._buttons.forEach((button, k) => {
            const [level] = LEVELS[k];
            button.disabled = !levels.has(level);
            button.ariaPressed = String(level === this._level);
        });
        this.element.hidden = levels.size < 2;
    }

    get _level() {
        return Math.max(this._chosen, this._least);
    }

    shows({ level }) {
        return level <= this._level;
    }
}
