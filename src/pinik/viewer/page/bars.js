/** Rows of a name, a bar from the middle or the left, and a number. */

import { make, say } from "pinik/elements.js";

export class Bars {
    /** @param options title, signed (bars begin in the middle), words(number) */
    constructor({ title, signed, words }) {
        Object.assign(this, { _signed: signed, _words: words, _rows: [] });
        this._list = make("ul", { className: signed ? "bars signed" : "bars" });
        this.element = make("section", { className: "bar-chart" }, make("h4", {}, title), this._list);
    }

    /** @param rows [{name, value, note}] */
    show(rows, most = Math.max(1e-12, ...rows.map(({ value }) => Math.abs(value)))) {
        this.element.hidden = rows.length === 0;
        while (this._rows.length > rows.length) this._rows.pop().row.remove();
        while (this._rows.length < rows.length) this._rows.push(this._make());
        rows.forEach(({ name, value, note = "" }, k) => {
            const own = this._rows[k];
            say(own.name, name);
            own.name.title = name;
            say(own.number, this._words(value) + note);
            own.bar.classList.toggle("minus", value < 0);
            own.bar.style.width = `${((this._signed ? 50 : 100) * Math.min(Math.abs(value) / most, 1)).toFixed(1)}%`;
        });
    }

    _make() {
        const own = { name: make("span"), bar: make("i"), number: make("span", { className: "number" }) };
        own.row = make("li", {}, own.name, make("div", {}, own.bar), own.number);
        this._list.append(own.row);
        return own;
    }
}
