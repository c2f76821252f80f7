/** Undo and redo of what was changed on this page: set-ups, and the poses that belonged to them. */

import { byId } from "pinik/elements.js";

const MOST = 100;
const PAUSE = 1000; // [ms] after which the same control begins another change
const NOT_CHANGES = new Set(["drawn", "run", "step", "begin_anew", "explain", "race", "bones"]);

export class Undo {
    constructor(connection) {
        this._connection = connection;
        this._before = [];
        this._after = [];
        this._last = { key: "", time: -Infinity };
        this._dirty = new WeakSet();
        connection.onSend = (message) => this._note(message);
        document.addEventListener("input", ({ target }) => this._dirty.add(target));
        document.addEventListener("change", ({ target }) => this._dirty.delete(target));
        const capture = { capture: true };
        document.addEventListener("pointerdown", () => this._hold(true), capture);
        for (const name of ["pointerup", "pointercancel"])
            document.addEventListener(name, () => this._hold(false), capture);
        document.addEventListener("keydown", (event) => this._press(event));
        byId("undo").addEventListener("click", () => this.undo());
        byId("redo").addEventListener("click", () => this.redo());
        this._show();
    }

    setRobot(robot) {
        this._followers = new Set(robot.joints.filter(({ leader }) => leader).map(({ name }) => name));
    }

    setState(state) {
        this._state = state;
    }

    _press(event) {
        const key = event.key.toLowerCase();
        if (!(event.ctrlKey || event.metaKey) || event.altKey || !["z", "y"].includes(key)) return;
        if (event.target.matches("textarea, input[type=search], input[type=text]")) return;
        if (this._dirty.has(event.target) && event.target.matches("input[type=number]")) return; // undoes the typing
        event.preventDefault();
        if (key === "y" || event.shiftKey) this.redo();
        else this.undo();
    }

    /** A drag is one change, however long it takes, and the next one is another. */
    _hold(isDown) {
        this._pressed = isDown;
        if (isDown) this._last.key = "";
        else this._last.time = performance.now();
    }

    /**
     * Remember what was before a message that changes something. The messages of one drag are one change, and so are
     * messages that follow each other before the session has answered the first, because nobody saw what was between.
     */
    _note(message) {
        if (this._silent || NOT_CHANGES.has(message.type) || !this._state) return;
        const { type, index, instance, name, angles } = message;
        const key = [type, index, instance, name, ...Object.keys(angles ?? {})].join();
        const now = performance.now();
        const goes = key === this._last.key && (this._pressed || now - this._last.time < PAUSE);
        this._last = { key, time: now };
        if (goes) return;
        const before = this._now();
        if (this._before.at(-1) !== before) this._before.push(before);
        this._before.splice(0, this._before.length - MOST);
        this._after = [];
        this._show();
    }

    /** The present set-up as text, with the pose in which the robots are. */
    _now() {
        const { setup, instances, motion } = this._state;
        if (motion !== "hand" || setup.includes("&angles=")) return setup;
        const free = (angles) => Object.entries(angles).filter(([name]) => !this._followers.has(name));
        const poses = instances.map(({ angles, placements }, i) => [i, { ...Object.fromEntries(free(angles)), ...placements }]);
        if (poses.some(([, angles]) => !Object.keys(angles).length)) return setup; // nothing moves
        return `${setup}&angles=${encodeURIComponent(JSON.stringify(Object.fromEntries(poses)))}&lead=balls`;
    }

    undo() {
        this._go(this._before, this._after);
    }

    redo() {
        this._go(this._after, this._before);
    }

    _go(from, to) {
        if (!this._state) return;
        const now = this._now();
        while (from.at(-1) === now) from.pop(); // what was sent there has changed nothing
        if (!from.length) {
            this._show();
            return;
        }
        to.push(now);
        const setup = from.pop().replace(/(^|&)run=\w+/, `$1run=${this._state.running ? "on" : "off"}`);
        this._last.key = "";
        this._silent = true;
        this._connection.send({ type: "setup", setup });
        this._silent = false;
        this._show();
    }

    _show() {
        byId("undo").disabled = !this._before.length;
        byId("redo").disabled = !this._after.length;
    }
}
