/** The statistics: one row per instance, all over the same steps. */

import { byId, make, say } from "pinik/elements.js";
import { offer, write } from "pinik/hands.js";
import { called, count, degrees, duration, length, percent, standing, tone } from "pinik/words.js";

const ENGINES = { native: "Stepped by the compiled engine", python: "Stepped by the engine in Python" };
const COLUMNS = [
    ["time", "mean-time", "time"],
    ["iterations", "mean-iterations", "iterations"],
    ["efficiency", "efficiency", "reached"],
    ["error", "mean-error", "error"],
    ["jump", "largest-jump", "max. jump"],
];

export class Table {
    constructor(table, connection) {
        this._body = table.tBodies[0];
        this._rows = [];
        byId("window").addEventListener("change", ({ target }) =>
            connection.send({ type: "statistics", cover: target.value }),
        );
        byId("begin-anew").addEventListener("click", () => connection.send({ type: "begin_anew" }));
    }

    setHello({ windows }) {
        offer(
            byId("window"),
            windows.map(({ name, title }) => [name, `Over ${title}`]),
        );
    }

    /** @param awaiting whether the robot's shapes are still being loaded */
    setState(state, awaiting) {
        const { instances } = state;
        while (this._rows.length > instances.length) this._rows.pop().row.remove();
        while (this._rows.length < instances.length) this._rows.push(this._make(this._rows.length));
        instances.forEach((instance, i) => this._show(i, instance, state, awaiting));
        write(byId("window"), state.window);
        const steps = Math.max(...instances.map(({ statistics }) => statistics.steps));
        say(byId("counted"), `${steps} step${steps === 1 ? "" : "s"}`);
        this._showCutOff(instances, steps);
    }

    /** Say where the clock ended steps, so that nobody takes that for the method's own doing. */
    _showCutOff(instances, steps) {
        const ended = instances.filter(({ statistics }) => statistics.cut_off > 0);
        const counts = ended.map((one) => `${called(one)} in ${one.statistics.cut_off}`);
        byId("cut-off").hidden = ended.length === 0;
        const whose = "That is this machine's doing, not the method's.";
        say(byId("cut-off"), `* The clock cut off ${counts.join(", ")} of ${steps} steps. ${whose}`);
    }

    _make(i) {
        const cells = { status: make("td", { className: "now", dataset: { testid: `status-${i}` } }) };
        for (const [name, testid, label] of COLUMNS)
            cells[name] = make("td", { dataset: { testid: `${testid}-${i}`, label } });
        const title = make("span");
        const engine = make("small", { dataset: { testid: `engine-${i}` } });
        const name = make("th", { scope: "row" }, make("span", { className: "dot" }), title, engine);
        const row = make("tr", {}, name, ...Object.values(cells));
        row.style.setProperty("--own", `var(--instance-${i})`);
        this._body.append(row);
        return { row, title, engine, ...cells };
    }

    _show(i, instance, state, awaiting) {
        const row = this._rows[i];
        const { statistics: mean, status, position_error, orientation_error, message, engine } = instance;
        say(row.title, called(instance));
        row.title.title = instance.title;
        say(row.engine, engine);
        row.engine.title = ENGINES[engine];
        say(row.status, standing(state, i, [status, position_error, orientation_error], awaiting));
        row.status.title = message;
        row.status.dataset.tone = tone(status);
        row.row.title = `Over ${mean.steps} steps; in ${mean.busy} of them the method had something to do`;
        // In a step in which only others had something to do, a method takes no time.
        const each = mean.busy ? mean.steps / mean.busy : 0;
        say(row.time, duration(mean.mean_time));
        row.time.title = each > 1 ? `${duration(mean.mean_time * each)} in each step with something to do` : "";
        say(row.iterations, count(mean.mean_iterations));
        // Only CCD, which moves one joint at a time, counts joint updates.
        const sweeps = mean.mean_joint_updates > 0;
        row.iterations.title = sweeps ? `sweeps, with ${count(mean.mean_joint_updates)} joint updates` : "iterations";
        if (sweeps) row.iterations.append(make("small", {}, ` / ${count(mean.mean_joint_updates)}`));
        say(row.efficiency, percent(mean.efficiency));
        row.efficiency.dataset.cut = mean.cut_off > 0;
        say(row.error, length(mean.mean_error));
        say(row.jump, degrees(mean.largest_jump));
    }
}
