/** The panel's other answers: ghosts of all of them, a click that takes one, and a slider along the self-motion. */

import { make, say } from "pinik/elements.js";
import { Ghosts } from "pinik/ghosts.js";

const MOVED = 1e-3; // [m] how far a ball may move before the answers are out of date

export class Answers {
    /**
     * @param place the element to fill
     * @param connection sends the messages
     * @param show the scene
     */
    constructor(place, connection, show) {
        this._connection = connection;
        this._ghosts = new Ghosts(show);
        this._all = make("button", { type: "button", dataset: { testid: "find-answers" } }, "Show other answers");
        this._motion = make("button", { type: "button", dataset: { testid: "find-self-motion" } }, "Find self-motion");
        this._all.title = "Every other way to reach the balls, as ghosts around the first robot; the balls stop";
        this._motion.title = "How the first robot can move while its hand stays on the ball; the balls stop";
        this._words = make("p", { className: "note", dataset: { testid: "answers-words" } });
        this._words.setAttribute("role", "status");
        this._list = make("div", { className: "line answers", dataset: { testid: "answers-list" } });
        this._slider = make("input", { type: "range", min: 0, step: 1, dataset: { testid: "self-motion-slider" } });
        this._slider.setAttribute("aria-label", "Place along the self-motion");
        this._slider.hidden = true;
        place.append(make("div", { className: "line" }, this._all, this._motion), this._words, this._list, this._slider);
        this._all.addEventListener("click", () => this._ask("find_answers"));
        this._motion.addEventListener("click", () => this._ask("find_self_motion", { instance: 0 }));
        this._slider.addEventListener("input", () =>
            connection.sendNewest("move along", { type: "move_along", index: Number(this._slider.value) }),
        );
    }

    _ask(type, fields = {}) {
        this.clear();
        say(this._words, "Searching …");
        this._searches = true;
        this._connection.send({ type, ...fields });
    }

    /** An error may have ended the search. */
    fail() {
        if (this._searches) this.clear();
    }

    /** Forget everything, because the robot or a ball has changed. */
    clear() {
        this._searches = false;
        this._ghosts.clear();
        this._list.replaceChildren();
        this._slider.hidden = true;
        this._asked = null;
        say(this._words, "");
    }

    /** Clear the ghosts once a ball has moved away from the place that they belong to. */
    setState(state) {
        if (!this._asked) return;
        const there = state.balls.map(({ mode, position }) => ({ mode, position }));
        const moved =
            there.length !== this._asked.length ||
            there.some(({ mode, position }, k) => {
                const before = this._asked[k];
                return mode !== before.mode || position.some((x, i) => Math.abs(x - before.position[i]) > MOVED);
            });
        if (moved) this.clear();
    }

    /** Take an `answers` message. */
    showAll({ message, balls, placements, distance }) {
        this.clear();
        this._remember(message, balls);
        this._ghosts.set(placements);
        const buttons = placements.map((_, index) => {
            const turn = `${Math.round((180 * distance[index]) / Math.PI)}°`;
            const title = `The joint that moves most moves by ${turn}. Click to take this answer.`;
            const button = make("button", { type: "button", title, dataset: { testid: `answer-${index}` } }, `${index + 1}`);
            button.addEventListener("click", () => this._connection.send({ type: "take_answer", index, instance: 0 }));
            for (const [event, shown] of [
                ["pointerenter", index],
                ["focus", index],
                ["pointerleave", null],
                ["blur", null],
            ])
                button.addEventListener(event, () => this._ghosts.choose(shown));
            return button;
        });
        this._list.replaceChildren(...buttons);
    }

    /** Take a `self_motion` message. */
    showMotion({ message, balls, placements, instance }) {
        this.clear();
        this._remember(message, balls);
        this._ghosts.set(
            placements.filter((_, k) => k % 6 === 0),
            instance,
        );
        this._slider.hidden = placements.length === 0;
        this._slider.max = Math.max(0, placements.length - 1);
        this._slider.value = 0;
    }

    _remember(message, balls) {
        say(this._words, message.slice(0, 1).toUpperCase() + message.slice(1));
        this._asked = balls;
    }
}
