/** The statistics: one row per instance, with means over the last thousand steps. */

import { make, say } from "pinik/elements.js";
import { count, degrees, length, milliseconds, percent, verdict } from "pinik/words.js";

export class Table {
    constructor(table) {
        this._body = table.tBodies[0];
        this._rows = [];
    }

    setState(state) {
        while (this._rows.length > state.instances.length) this._rows.pop().row.remove();
        while (this._rows.length < state.instances.length) this._rows.push(this._make(this._rows.length));
        state.instances.forEach((instance, i) => this._show(this._rows[i], instance, state));
    }

    _make(i) {
        const cell = (testid) => make("td", { dataset: { testid: `${testid}-${i}` } });
        const cells = {
            status: cell("status"),
            time: cell("mean-time"),
            iterations: cell("mean-iterations"),
            efficiency: cell("efficiency"),
            error: cell("mean-error"),
            jump: cell("largest-jump"),
        };
        const title = make("span");
        const name = make("th", { scope: "row" }, make("span", { className: "dot" }), title);
        const row = make("tr", {}, name, ...Object.values(cells));
        row.style.setProperty("--own", `var(--instance-${i})`);
        this._body.append(row);
        return { row, title, ...cells };
    }

    _show(row, instance, state) {
        const { statistics: mean, status, position_error, orientation_error, message } = instance;
        const orNaN = (value) => value ?? NaN;
        say(row.title, instance.method);
        row.title.title = instance.title;
        say(row.status, verdict(status, orNaN(position_error), orNaN(orientation_error), state));
        row.status.title = message;
        row.status.dataset.tone = status === "CONVERGED" ? "good" : status === "IDLE" ? "idle" : "missed";
        row.row.title = `Means over ${mean.steps} steps`;
        say(row.time, milliseconds(mean.mean_time));
        say(row.iterations, count(mean.mean_iterations));
        // Only CCD, which moves one joint at a time, counts joint updates.
        const sweeps = mean.mean_joint_updates > 0;
        row.iterations.title = sweeps ? `sweeps, with ${count(mean.mean_joint_updates)} joint updates` : "iterations";
        if (sweeps) row.iterations.append(make("small", {}, ` / ${count(mean.mean_joint_updates)}`));
        say(row.efficiency, percent(mean.efficiency));
        say(row.error, length(mean.mean_error));
        say(row.jump, degrees(mean.largest_jump));
    }
}
