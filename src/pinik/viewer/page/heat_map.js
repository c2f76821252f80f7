/** A matrix as coloured cells, with the names of its rows and columns, a residual at its right and a step below. */

import { make } from "pinik/elements.js";

export class HeatMap {
    /** @param theme gives the colours of positive and negative numbers */
    constructor(theme) {
        this._theme = theme;
        this.element = make("div", { className: "heat", tabIndex: 0, role: "group", aria: { label: "The Jacobian as a heat map" } });
        this._drawn = "";
        theme.addEventListener("change", () => this._last && this.show(this._last));
    }

    /** @param explained the `explanation` message */
    show(explained) {
        this._last = explained;
        const { columns, rows } = explained;
        const drawn = [columns, rows].join("|");
        if (drawn !== this._drawn) {
            this._drawn = drawn;
            this._make(columns, rows);
        }
        const J = explained.J;
        const most = (numbers) => Math.max(1e-12, ...numbers.map(Math.abs));
        const scale = most(J.flat());
        const [scaleOfE, scaleOfStep] = [most(explained.e), most(explained.step)];
        rows.forEach((row, r) => {
            columns.forEach((column, c) => {
                const held = explained.held.includes(column);
                const words = held ? "held by a limit" : `${signed(J[r][c])} m per rad or m`;
                this._paint(this._cells[r][c], J[r][c] / scale, `${row} by ${column}: ${words}`);
                this._cells[r][c].classList.toggle("held", held);
            });
            this._paint(this._e[r], explained.e[r] / scaleOfE, `residual of ${row}: ${signed(explained.e[r])} m`);
        });
        columns.forEach((column, c) => {
            const change = explained.step[c];
            this._paint(this._step[c], change / scaleOfStep, `step of ${column}: ${signed(change)} rad or m`);
        });
    }

    _make(columns, rows) {
        const cell = () => make("i", { role: "img" });
        const label = (text, className) => make("span", { className, title: text }, text);
        this._cells = rows.map(() => columns.map(cell));
        this._e = rows.map(cell);
        this._step = columns.map(cell);
        const gap = () => make("b");
        const lines = rows.flatMap((row, r) => [label(row, "row"), ...this._cells[r], gap(), this._e[r]]);
        const heads = columns.map((name) => make("span", { className: "column", title: name }, make("em", {}, name)));
        const longest = Math.min(18, Math.max(...columns.map((name) => name.length)));
        this.element.style.setProperty("--columns", columns.length);
        this.element.style.setProperty("--head", `${14 + 5.2 * longest}px`);
        this.element.replaceChildren(
            gap(), ...heads, gap(), make("span", { className: "column" }, make("em", {}, "e")),
            ...lines,
            label("Δq", "row last"), ...this._step, gap(), gap(),
        );
    }

    _paint(cell, part, words) {
        const own = part < 0 ? "minus" : "plus";
        const strength = Math.round(100 * Math.min(Math.abs(part), 1) ** 0.7);
        cell.style.background = `color-mix(in srgb, var(--${own}) ${strength}%, var(--wash))`;
        cell.title = words;
        cell.ariaLabel = words;
    }
}

function signed(number) {
    return `${number < 0 ? "−" : "+"}${Math.abs(number).toPrecision(3)}`;
}
