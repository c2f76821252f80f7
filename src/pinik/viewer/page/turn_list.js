/** The turns of a sweep as a list that plays slowly, one turn after the other. */

import { make } from "pinik/elements.js";
import { degrees, length } from "pinik/words.js";

const TURN = 900; // [ms] for one turn
const PAUSE = 350; // [ms] after it

export class TurnList {
    /** @param onTurn called with the turn to draw and how much of it has been made, or with null */
    constructor(onTurn) {
        this._onTurn = onTurn;
        this._turns = [];
        this._at = 0;
        this._play = make("button", { type: "button", className: "soft", dataset: { testid: "replay" }, title: "Play the turns slowly (,)" }, "Play slowly");
        this._play.addEventListener("click", () => (this._playing ? this._stop() : this.replay()));
        this._list = make("ol", { className: "turns", dataset: { testid: "turns" } });
        this.element = make("section", { hidden: true }, make("div", { className: "title" }, make("h4", {}, "The sweep, joint by joint"), this._play), this._list);
    }

    /** @param running whether the session runs: nothing is drawn then, because the next sweep follows at once */
    show(turns, running) {
        const same = JSON.stringify(turns) === JSON.stringify(this._turns);
        if (same && running === this._running) return;
        this._running = running;
        this._turns = turns;
        this.element.hidden = turns.length === 0;
        if (!same) {
            this._list.replaceChildren(...turns.map((turn, k) => this._row(turn, k)));
            this._stop();
        }
        this._show(running || !turns.length ? null : 0, 1);
    }

    _row({ joint, slides, change, limited }, k) {
        const words = slides ? length(change) : degrees(change);
        const button = make("button", { type: "button" }, make("span", {}, joint), make("span", { className: "number" }, words + (limited ? " to its limit" : "")));
        button.addEventListener("click", () => this._from(k, k + 1));
        return make("li", {}, button);
    }

    replay() {
        this._from(0, this._turns.length);
    }

    _from(first, end) {
        this._stop();
        if (!this._turns.length) return;
        let began = null;
        this._playing = true;
        this._play.textContent = "Stop";
        const draw = (now) => {
            if (!this._playing) return;
            began ??= now;
            const passed = Math.max(0, now - began);
            const k = first + Math.floor(passed / (TURN + PAUSE));
            if (k >= end) {
                this._show(end - 1, 1);
                this._stop();
                return;
            }
            const part = Math.min((passed % (TURN + PAUSE)) / TURN, 1);
            this._show(k, part * part * (3 - 2 * part));
            requestAnimationFrame(draw);
        };
        requestAnimationFrame(draw);
    }

    _stop() {
        this._playing = false;
        this._play.textContent = "Play slowly";
    }

    _show(k, part) {
        [...this._list.children].forEach((row, at) => row.classList.toggle("now", at === k));
        if (k !== null && this._list.children[k]) {
            const row = this._list.children[k];
            this._list.scrollTop = row.offsetTop - this._list.offsetTop - this._list.clientHeight / 2;
        }
        this._onTurn(k === null ? null : this._turns[k], part);
    }
}
