/** The joints in the panel: a slider for each. Moving one makes the joints lead, and the balls follow. */

import { byId, make, say } from "pinik/elements.js";
import { offer, typed, write } from "pinik/hands.js";

const DEGREE = Math.PI / 180;
const ONE_AXIS = new Set(["revolute", "continuous", "prismatic"]);

export class Joints {
    constructor(connection) {
        this._connection = connection;
        this._rows = [];
        byId("joints-of").addEventListener("change", () => this.state && this.setState(this.state));
        byId("joint-search").addEventListener("input", () => this._search());
        byId("balls-lead").addEventListener("click", () => connection.send({ type: "balls_lead" }));
        byId("joints").addEventListener("toggle", () => this.state && this.setState(this.state));
    }

    /** The instance whose joints are shown and set: its number, or null for all. */
    get instance() {
        const { value } = byId("joints-of");
        return value === "" ? null : Number(value);
    }

    setRobot(robot) {
        this._rows = robot.joints.filter(({ kind }) => ONE_AXIS.has(kind)).map((joint) => this._make(joint));
        byId("joint-list").replaceChildren(...this._rows.map(({ row }) => row));
        byId("joint-search").value = "";
        byId("joint-search").hidden = this._rows.length < 9;
        this._search();
    }

    _make({ name, kind, leader, range }) {
        const unit = kind === "prismatic" ? { name: "m", size: 1, step: 0.001 } : { name: "°", size: DEGREE, step: 0.1 };
        const follows = leader ? `${name} follows ${leader}` : name;
        const slider = make("input", {
            type: "range",
            step: unit.step,
            disabled: Boolean(leader),
            dataset: { testid: `joint-${name}` },
            aria: { label: `${follows} (slider)` },
        });
        const number = make("input", {
            type: "number",
            step: "any",
            disabled: Boolean(leader),
            dataset: { testid: `joint-number-${name}` },
            aria: { label: `${name} in ${kind === "prismatic" ? "metres" : "degrees"}` },
        });
        slider.addEventListener("input", () => {
            number.value = slider.value;
            this._send(name, Number(slider.value) * unit.size, true);
        });
        number.addEventListener("change", () => {
            const value = typed(number);
            if (value !== null) this._send(name, value * unit.size);
        });
        const title = make("span", { className: "joint-name", title: follows }, name);
        const row = make("li", { title: words(range, unit, leader) }, title, slider, number, make("small", {}, unit.name));
        row.classList.toggle("faint", Boolean(leader));
        return { row, name, leader, range, unit, slider, number, kind };
    }

    _send(name, value, often = false) {
        const message = { type: "angles", instance: this.instance, angles: { [name]: value } };
        if (often) this._connection.sendNewest(`angle ${name}`, message);
        else this._connection.send(message);
    }

    setState(state) {
        this.state = state;
        const robots = state.instances.map(({ method }, i) => [String(i), `Robot ${i + 1}: ${method}`]);
        offer(byId("joints-of"), state.view === 1 ? [["", "The robot"]] : [["", "All robots"], ...robots]);
        byId("joints-lead").hidden = !state.led.length;
        say(byId("joints-lead-words"), leading(state));
        if (!byId("joints").open) return;
        const { angles } = state.instances[this.instance ?? 0];
        for (const { name, range, unit, slider, number, kind } of this._rows) {
            const [low, high] = reach(range, kind, state.limits);
            const value = angles[name];
            // A value beyond the ends, as without limits, moves the end, so that the slider does not lie.
            slider.min = Math.floor((10 * Math.min(low, value)) / unit.size / unit.step) * unit.step / 10;
            slider.max = Math.ceil((10 * Math.max(high, value)) / unit.size / unit.step) * unit.step / 10;
            if (range && state.limits) [slider.min, slider.max] = [low / unit.size, high / unit.size];
            write(slider, (value / unit.size).toFixed(unit.name === "m" ? 4 : 2));
            write(number, String(Number((value / unit.size).toFixed(unit.name === "m" ? 4 : 1))));
        }
    }

    _search() {
        const wanted = byId("joint-search").value.trim().toLowerCase();
        let shown = 0;
        for (const { row, name } of this._rows) {
            row.hidden = !name.toLowerCase().includes(wanted);
            shown += row.hidden ? 0 : 1;
        }
        byId("no-joint").hidden = shown > 0;
        say(byId("no-joint"), this._rows.length ? "No joint has this in its name." : "No joint of this robot moves.");
    }
}

/** The ends of a slider [rad or m]: the limits, or half a turn or a metre to each side where there are none. */
function reach(range, kind, limited) {
    if (range && limited) return range;
    const half = kind === "prismatic" ? 1 : Math.PI;
    return [Math.min(-half, range?.[0] ?? 0), Math.max(half, range?.[1] ?? 0)];
}

function words(range, { name, size }, leader) {
    const ends = range?.map((end) => `${Number((end / size).toFixed(name === "m" ? 4 : 1))} ${name}`);
    return `${leader ? `follows ${leader}; ` : ""}${ends ? `from ${ends[0]} to ${ends[1]}` : "without limits"}`;
}

function leading({ led, view }) {
    if (led.length >= view) return "The joints lead, and the ball follows.";
    return `The joints of robot ${led.map((i) => i + 1).join(", ")} lead, and the ball follows.`;
}
