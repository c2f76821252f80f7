/** The tab with the thesis's Table 4.1, filled while one walks through its four comparisons. */

import { contest } from "pinik/contest.js";
import { make, say } from "pinik/elements.js";
import { count, microseconds } from "pinik/words.js";

const NAMES = { thesis: "the thesis's parameters", tuned: "pinik's own parameters" };

export class ThesisTable {
    /** @param walk called with a comparison's number and preset */
    constructor(walk) {
        this._walk = walk;
        this._figures = new Map();
        this._preset = make("select", { className: "small", dataset: { testid: "thesis-preset" }, aria: { label: "Parameters" } });
        this._preset.addEventListener("change", () => this._empty());
        this._words = make("p", { className: "hint", role: "status", dataset: { testid: "thesis-words" } }, "Choose a comparison: the table fills while it runs.");
        this._body = make("div", { className: "walk" });
        this.element = make("div", { className: "thesis" },
            make("p", { className: "hint" }, "Šimunić 2012, Table 4.1: time, iterations (turned bones for CCD) and efficiency of each step. Below each published figure stands what this session measures."),
            this._preset, this._words, this._body);
    }

    setHello({ thesis }) {
        this._thesis = thesis;
        this._preset.replaceChildren(...thesis.presets.map((name) => make("option", { value: name }, NAMES[name] ?? name)));
        this._make();
    }

    _empty() {
        this._figures.clear();
        this._now = null;
        this._make();
    }

    _make() {
        const { comparisons, methods } = this._thesis;
        this._cells = new Map();
        this._body.replaceChildren(...comparisons.map(({ number, title }, k) => {
            const button = make("button", { type: "button", className: "soft", dataset: { testid: `comparison-${number}` } }, `${number}: ${title}`);
            button.addEventListener("click", () => this._go(number));
            const head = make("tr", {}, ...["", "time", "iterations", "efficiency"].map((word) => make("th", { scope: "col" }, word)));
            const rows = methods.map(({ name, published }) => this._row(number, name, published[k]));
            return make("section", {}, button, make("table", {}, make("thead", {}, head), make("tbody", {}, ...rows)));
        }));
        this._fill();
    }

    _row(number, method, published) {
        const own = ["time", "iterations", "efficiency"].map((name) => make("small", { dataset: { testid: `walk-${number}-${method}-${name}` } }, "–"));
        this._cells.set(`${number} ${method}`, own);
        const words = [microseconds(published.time), String(published.iterations), `${Math.round(100 * published.efficiency)} %`];
        return make("tr", {}, make("th", { scope: "row" }, method), ...words.map((text, k) => make("td", {}, text, own[k])));
    }

    _go(number) {
        this._now = { number, joints: null, key: null };
        this._walk(number, this._preset.value);
        say(this._words, `Comparison ${number} begins …`);
    }

    /** @param bones the `bones` message: joints per bone of the comparison that has begun */
    setBones({ number, joints_per_bone: joints }) {
        if (this._now?.number === number) this._now.joints = joints;
    }

    /** Take the figures of the comparison that runs, until somebody changes a setting. */
    setState(state) {
        const now = this._now;
        if (!now || now.joints === null) return;
        const key = settings(state);
        now.key ??= key;
        if (key !== now.key) {
            this._now = null;
            say(this._words, "A setting has changed, so the table waits for the next comparison.");
            return;
        }
        for (const { method, statistics } of state.instances) {
            if (!statistics.steps) continue;
            const sweeps = statistics.mean_joint_updates > 0;
            this._figures.set(`${now.number} ${method}`, {
                steps: statistics.steps,
                time: microseconds(statistics.mean_time),
                iterations: count(sweeps ? statistics.mean_joint_updates / now.joints : statistics.mean_iterations),
                efficiency: `${Math.round(100 * statistics.efficiency)} %`,
            });
        }
        const steps = Math.max(0, ...state.instances.map(({ statistics }) => statistics.steps));
        say(this._words, `Comparison ${now.number}: means over ${steps} steps. The thesis took 1000.`);
        this._fill();
    }

    _fill() {
        for (const [name, cells] of this._cells) {
            const figures = this._figures.get(name);
            const [time, iterations, efficiency] = cells;
            say(time, figures?.time ?? "–");
            say(iterations, figures?.iterations ?? "–");
            say(efficiency, figures?.efficiency ?? "–");
        }
    }
}

/** What must stay as it is while a comparison is measured. */
function settings(state) {
    const { view, motion, curve, speed, polish, iterations } = state;
    return JSON.stringify([contest(state), view, motion, curve, speed, polish, iterations]);
}
