/** A parameter that maps joints to numbers: a list of those joints, and a menu of the others. */

import { icon, make } from "pinik/elements.js";
import { Asked, offer, typed, write } from "pinik/hands.js";
import { plain } from "pinik/words.js";

export class JointValues {
    constructor({ name, low, high }, testid, commit) {
        this._name = name;
        this._range = { low, high };
        this._testid = testid;
        this._asked = new Asked();
        this._change = (change) => commit(this._asked.ask("", change(this._asked.now("", this._value))));
        this._value = {};
        this._rows = new Map();
        this.list = make("ul", { className: "joint-values" });
        this.adder = make("select", { dataset: { testid }, aria: { label: `${name}: add a joint` } });
        this.adder.addEventListener("change", () => {
            const joint = this.adder.value;
            const number = this._range.high === null ? 0 : this._range.high / 2;
            if (joint) this._change((value) => ({ ...value, [joint]: number }));
            this.adder.value = "";
        });
    }

    show(value, jointNames) {
        this._value = value;
        const free = jointNames.filter((joint) => !(joint in value));
        offer(this.adder, [["", "add a joint …"], ...free.map((joint) => [joint, joint])]);
        for (const [joint, { row }] of this._rows) {
            if (joint in value) continue;
            row.remove();
            this._rows.delete(joint);
        }
        for (const [joint, number] of Object.entries(value)) {
            if (!this._rows.has(joint)) this._rows.set(joint, this._make(joint));
            write(this._rows.get(joint).input, plain(number));
        }
    }

    _make(joint) {
        const { low, high } = this._range;
        const input = make("input", {
            type: "number",
            step: "any",
            dataset: { testid: `${this._testid}-${joint}` },
            aria: { label: joint },
        });
        if (low !== null) input.min = low;
        if (high !== null) input.max = high;
        input.addEventListener("change", () => {
            const number = typed(input);
            if (number !== null) this._change((value) => ({ ...value, [joint]: number }));
        });
        const remove = make(
            "button",
            { type: "button", className: "quiet", title: `Remove ${joint}`, aria: { label: `Remove ${joint}` } },
            icon("close"),
        );
        remove.addEventListener("click", () => this._change(({ [joint]: _, ...others }) => others));
        const row = make("li", {}, make("span", {}, joint), input, remove);
        this.list.append(row);
        return { row, input };
    }
}
