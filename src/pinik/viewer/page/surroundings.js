/** The panel's collisions and obstacles. */

import { icon, make, say } from "pinik/elements.js";
import { typed, write } from "pinik/hands.js";

const SIZES = { box: ["length", "width", "height"], sphere: ["radius"] };
const NEW = { box: [0.16, 0.16, 0.16], sphere: [0.09] }; // as fractions of the robot's size

export class Surroundings {
    /**
     * @param place the element to fill
     * @param connection sends the messages
     */
    constructor(place, connection) {
        this._send = (type, fields) => connection.send({ type, ...fields });
        this._on = this._check("collisions", "Show what touches", "Links and obstacles that touch turn red");
        this._avoid = this._check("avoid", "Avoid it", "A robot whose next place would touch something goes elsewhere, or waits");
        this._words = make("p", { className: "note", dataset: { testid: "collisions-words" } });
        this._list = make("ul", { className: "obstacles" });
        const add = Object.keys(SIZES).map((kind) => {
            const button = make("button", { type: "button", dataset: { testid: `add-${kind}` } }, `Add a ${kind}`);
            button.addEventListener("click", () => this._add(kind));
            return button;
        });
        const checks = make("div", { className: "line checks" }, this._on.label, this._avoid.label);
        place.append(checks, this._words, this._list, make("div", { className: "line" }, ...add));
        this._rows = [];
    }

    _check(name, text, title) {
        const input = make("input", { type: "checkbox", dataset: { testid: name } });
        const label = make("label", { className: "check", title }, input, text);
        input.addEventListener("change", () => {
            const avoid = this._avoid.input.checked;
            // Switching "avoid" on looks for touches too; switching those off ends both.
            const on = name === "avoid" ? avoid || this._on.input.checked : this._on.input.checked;
            this._send("collisions", { on, avoid: avoid && on });
        });
        return { input, label };
    }

    setRobot(robot) {
        this._size = robot.size;
    }

    _add(kind) {
        const size = NEW[kind].map((part) => Number((part * this._size).toPrecision(2)));
        const ball = this._state.balls.find(({ mode }) => mode !== "off") ?? this._state.balls[0];
        const beside = ball.position.map((x, i) => Number((x + (i === 1 ? 0.3 * this._size : 0)).toFixed(3)));
        this._send("add_obstacle", { kind, size, position: beside });
        if (!this._state.collisions.on) this._send("collisions", { on: true, avoid: false });
    }

    setState(state) {
        this._state = state;
        const { on, avoid, loading, why_not: whyNot } = state.collisions;
        write(this._on.input, on);
        write(this._avoid.input, avoid);
        const touching = state.instances.flatMap(({ method, touching: pairs }) =>
            pairs.slice(0, 2).map(([a, b]) => `${method}: ${a} touches ${b}`),
        );
        const found = touching.length ? touching.join("; ") : "Nothing touches";
        say(this._words, on ? whyNot || (loading ? "Reading the collision shapes …" : found) : "");
        this._words.classList.toggle("touched", touching.length > 0);
        const kinds = state.obstacles.map(({ kind }) => kind).join();
        if (kinds !== this._kinds) {
            this._kinds = kinds;
            this._rows = state.obstacles.map((obstacle, k) => this._row(obstacle, k));
            this._list.replaceChildren(...this._rows.map(({ row }) => row));
        }
        state.obstacles.forEach(({ position, size }, k) => {
            [...position, ...size].forEach((value, i) => write(this._rows[k].inputs[i], Number(value.toFixed(3))));
        });
    }

    _row({ kind }, k) {
        const names = ["x", "y", "z", ...SIZES[kind]];
        const inputs = names.map((name) => {
            const label = `${name} of obstacle ${k + 1} in metres`;
            const input = make("input", { type: "number", step: 0.01, title: label, dataset: { testid: `obstacle-${k}-${name}` } });
            input.setAttribute("aria-label", label);
            input.addEventListener("change", () => this._change(k));
            return input;
        });
        const close = make("button", { type: "button", className: "quiet", title: `Remove obstacle ${k + 1}` }, icon("close"));
        close.dataset.testid = `remove-obstacle-${k}`;
        close.setAttribute("aria-label", `Remove obstacle ${k + 1}`);
        close.addEventListener("click", () => this._send("remove_obstacle", { index: k }));
        const head = make("div", { className: "line obstacle-head" }, make("span", {}, `Obstacle ${k + 1}, a ${kind} [m]`), close);
        const fields = inputs.map((input, i) => make("label", { className: "field" }, make("span", {}, names[i]), input));
        const places = make("div", { className: "trio" }, ...fields.slice(0, 3));
        const sizes = make("div", { className: "trio" }, ...fields.slice(3));
        return { row: make("li", {}, head, places, sizes), inputs };
    }

    _change(k) {
        const values = this._rows[k].inputs.map(typed);
        const told = this._state.obstacles[k];
        const [position, size] = [values.slice(0, 3), values.slice(3)];
        const differ = (some, others) => some.some((x, i) => x !== Number(others[i].toFixed(3)));
        if (position.every((x) => x !== null) && differ(position, told.position))
            this._send("obstacle", { index: k, position });
        if (size.every((x) => x !== null) && differ(size, told.size)) this._send("obstacle_size", { index: k, size });
    }
}
