/** How much a method makes of each singular value: its gain over σ as a curve, and a dot for each of J's values. */

import { make } from "pinik/elements.js";

const [WIDTH, HEIGHT, LEFT, BOTTOM, TOP, RIGHT] = [340, 150, 38, 26, 10, 8];
const POINTS = 160;

/** The gain over σ; `value` is α, τ or λ. */
const GAINS = {
    jt: (sigma, alpha) => alpha * sigma,
    pinv: (sigma, tau) => (sigma > tau ? 1 / sigma : 0),
    dls: (sigma, lambda) => sigma / (sigma * sigma + lambda * lambda),
};

function svg(tag, attributes, ...children) {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    element.append(...children);
    return element;
}

export class GainCurve {
    constructor() {
        this._svg = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": "Gain over singular value" });
        this.element = make("div", { className: "gain" }, this._svg);
    }

    /** @param explained the `explanation` message */
    show({ method, sigma, gains, value }) {
        const gain = GAINS[method];
        this.element.hidden = !gain || !sigma.length;
        if (this.element.hidden) return;
        const far = 1.12 * sigma[0] || 1;
        // Where 1/σ goes through the ceiling it is cut off, so that the values that matter keep their places.
        const top = this._top(method, sigma, gains, value);
        const x = (s) => LEFT + (s / far) * (WIDTH - LEFT - RIGHT);
        const y = (g) => HEIGHT - BOTTOM - (Math.min(g, 1.05 * top) / (1.05 * top)) * (HEIGHT - BOTTOM - TOP);
        const path = (of) => Array.from({ length: POINTS + 1 }, (_, k) => (k / POINTS) * far || far / 1e4)
            .map((s, k) => `${k ? "L" : "M"}${x(s).toFixed(1)} ${y(of(s)).toFixed(1)}`).join("");
        const parts = [
            ...this._axes(x, y, far, top),
            ...(method === "dls" ? [svg("path", { d: path((s) => 1 / s), class: "other" })] : []),
            svg("path", { d: path((s) => gain(s, value)), class: "curve" }),
            ...this._mark(method, value, x, far),
            ...sigma.map((s, i) => this._dot(i, s, gains[i], x, y, top)),
            text(WIDTH - RIGHT, TOP + 6, "gain [1/m]", "end"),
        ];
        this._svg.replaceChildren(...parts);
    }

    _top(method, sigma, gains, value) {
        const highest = method === "dls" ? Math.min(1 / (2 * value), 40 / sigma[0]) : Math.min(Math.max(...gains), 40 / sigma[0]);
        return Math.max(highest, 1.2 * Math.min(...gains), 1e-9);
    }

    _axes(x, y, far, top) {
        const ticks = [...round(far).map((s) => ["x", s]), ...round(top).map((g) => ["y", g])];
        const lines = ticks.map(([axis, v]) => axis === "x"
            ? svg("line", { x1: x(v), x2: x(v), y1: TOP, y2: HEIGHT - BOTTOM, class: "hair" })
            : svg("line", { x1: LEFT, x2: WIDTH - RIGHT, y1: y(v), y2: y(v), class: "hair" }));
        const words = ticks.map(([axis, v]) => axis === "x"
            ? text(x(v), HEIGHT - BOTTOM + 12, plain(v), "middle")
            : text(LEFT - 4, y(v) + 3.5, plain(v), "end"));
        return [...lines, ...words, text(WIDTH - RIGHT, HEIGHT - 2, "σ [m]", "end")];
    }

    _mark(method, value, x, far) {
        const name = { pinv: "τ", dls: "λ" }[method];
        if (!name || value > far || value < far / 300) return [];
        return [
            svg("line", { x1: x(value), x2: x(value), y1: TOP, y2: HEIGHT - BOTTOM, class: "mark" }),
            text(x(value) + 3, HEIGHT - BOTTOM - 4, name, "start"),
        ];
    }

    _dot(i, sigma, gain, x, y, top) {
        const words = `σ${i + 1} = ${plain(sigma)} m, gain ${plain(gain)} per metre${gain > 1.05 * top ? " (beyond the picture)" : ""}`;
        return svg("circle", { cx: x(sigma), cy: y(gain), r: 4.5, class: "dot" }, svg("title", {}, words));
    }
}

function text(x, y, words, anchor) {
    return svg("text", { x, y, "text-anchor": anchor }, words);
}

/** Two or three round numbers up to `far`. */
function round(far) {
    const power = 10 ** Math.floor(Math.log10(far));
    const each = [0.5, 1, 2].map((factor) => factor * power).find((step) => far / step <= 4) ?? 5 * power;
    return Array.from({ length: Math.floor(far / each) + 1 }, (_, k) => k * each);
}

function plain(number) {
    return String(Number(number.toPrecision(3)));
}
