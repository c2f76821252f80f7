/** The two charts beside the table: the errors of the last seconds, and the solvers' times. */

import { Chart } from "pinik/chart.js";
import { byId } from "pinik/elements.js";
import { History } from "pinik/history.js";
import { length, microseconds } from "pinik/words.js";

const INTERVAL = 100; // [ms] between two drawings

export class Charts {
    constructor(theme) {
        this._history = new History();
        this._drawn = 0;
        this._state = null;
        this._errors = new Chart(byId("error-chart"), theme, {
            value: ({ error }) => error * 1000,
            words: (millimetres) => length(millimetres / 1000),
            decades: 4,
        });
        this._times = new Chart(byId("time-chart"), theme, {
            value: ({ seconds }) => seconds * 1e6,
            words: (micros) => microseconds(micros / 1e6),
            decades: 2,
        });
    }

    setState(state) {
        this._state = state;
        for (const chart of [this._errors, this._times]) chart.setState(state);
    }

    /** Take a frame at a time [s] of the session. */
    add(frame, time) {
        this._history.add(frame, time);
    }

    /** Draw, if the last drawing is long enough ago; `now` is in milliseconds. */
    tick(now) {
        if (now - this._drawn < INTERVAL || !this._state) return;
        this._drawn = now;
        this._errors.draw(this._history, this._state.tolerance.position * 1000);
        this._times.draw(this._history, null);
    }
}
