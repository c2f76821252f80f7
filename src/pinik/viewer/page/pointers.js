/** Arrows at the edge of the picture that point to balls outside it. A click shows everything again. */

import { make } from "pinik/elements.js";

const INSET = 22; // [px] from the edge
const MOST = 8;

export class Pointers {
    /** @param show the scene */
    constructor(labels, show) {
        this._show = show;
        this._arrows = [];
        this._element = make("div", { className: "pointers" });
        labels.after(this._element);
    }

    /** @param above the height of what stands at the upper edge, which no arrow may cover [px] */
    place(above) {
        const { stage, state } = this._show;
        const room = { width: stage.width, height: stage.height };
        const outside = this._show
            .ballsOnScreen()
            .filter(({ at, radius }) => at.behind || isOutside(at, radius, room))
            .slice(0, MOST);
        while (this._arrows.length < outside.length) this._arrows.push(this._make());
        while (this._arrows.length > outside.length) this._arrows.pop().remove();
        outside.forEach(({ k, instance, at }, i) => {
            const arrow = this._arrows[i];
            const { x, y, turn } = onEdge(at, room, above);
            arrow.style.setProperty("--own", `var(--instance-${instance})`);
            arrow.style.transform = `translate(${x.toFixed(0)}px, ${y.toFixed(0)}px) rotate(${turn.toFixed(2)}rad)`;
            arrow.ariaLabel = arrow.title = `The ball of ${state.balls[k].frame} is outside the picture. Show everything`;
        });
    }

    _make() {
        const arrow = make("button", { type: "button", className: "pointer", dataset: { testid: "pointer" } });
        arrow.addEventListener("click", () => this._show.frameAll());
        this._element.append(arrow);
        return arrow;
    }
}

function isOutside({ x, y }, radius, { width, height }) {
    return x < -radius || y < -radius || x > width + radius || y > height + radius;
}

/** Where the line from the middle of the free picture to a point crosses its edge, and the line's angle [rad]. */
function onEdge({ x, y, behind }, { width, height }, above) {
    const sign = behind ? -1 : 1; // a point behind the camera is seen on the opposite side
    const middle = { x: width / 2, y: (above + height) / 2 };
    const [dx, dy] = [sign * (x - middle.x), sign * (y - middle.y)];
    const [right, down] = [width / 2 - INSET, (height - above) / 2 - INSET];
    const part = Math.min(right / Math.max(Math.abs(dx), 1e-6), down / Math.max(Math.abs(dy), 1e-6));
    return { x: middle.x + part * dx, y: middle.y + part * dy, turn: Math.atan2(dy, dx) };
}
