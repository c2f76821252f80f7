/** The "Show" menu, and the button for robots in one place. */

import { byId, make } from "pinik/elements.js";
import { write } from "pinik/hands.js";

const BUTTONS = ["overlay"]; // looks that are not in the menu

export class LookMenu {
    constructor(connection) {
        this._connection = connection;
        this._boxes = new Map();
        byId("overlay").addEventListener("click", () => this.turn("overlay"));
        const menu = byId("show-menu");
        document.addEventListener("pointerdown", ({ target }) => {
            if (!menu.contains(target)) menu.open = false;
        });
        menu.addEventListener("keydown", ({ key }) => {
            if (key !== "Escape" || !menu.open) return;
            menu.open = false;
            menu.querySelector("summary").focus();
        });
    }

    setHello({ looks }) {
        const listed = looks.filter(({ name }) => !BUTTONS.includes(name));
        this._boxes = new Map(listed.map(({ name, about }) => [name, this._box(name, about)]));
        const rows = listed.map(({ name, title, about }) =>
            make("label", { className: "check", title: about }, this._boxes.get(name), title),
        );
        byId("looks").replaceChildren(...rows);
    }

    _box(name) {
        const box = make("input", { type: "checkbox", dataset: { testid: `look-${name}` } });
        box.addEventListener("change", () => this._send(name, box.checked));
        return box;
    }

    setState({ looks, view }) {
        this._on = new Set(looks);
        for (const [name, box] of this._boxes) write(box, this._on.has(name));
        byId("overlay").ariaPressed = String(this._on.has("overlay"));
        byId("overlay").disabled = view === 1;
        const some = looks.some((name) => this._boxes.has(name));
        byId("show-menu").classList.toggle("some", some);
    }

    turn(name) {
        this._send(name, !this._on.has(name));
    }

    _send(name, on) {
        this._connection.send({ type: "look", name, on });
    }
}
