/** The balls in the panel: frame, mode, position and orientation. */

import { byId, icon, make, say } from "pinik/elements.js";
import { Asked, offer, typed, write } from "pinik/hands.js";
import { plain } from "pinik/words.js";

const DEGREE = Math.PI / 180;
const MODES = [
    ["on", "on"],
    ["pinned", "pinned"],
    ["off", "off"],
];
const POSITION = ["target-x", "target-y", "target-z"];
const AXES = ["x", "y", "z"];
const FREE = AXES.map((axis) => `target-${axis}-free`);
const TURN = ["roll", "pitch", "yaw"];

export class Targets {
    /** @param onSelect called with the index of the ball that is selected */
    constructor(connection, onSelect) {
        this._connection = connection;
        this._onSelect = onSelect;
        this._rows = [];
        this._asked = new Asked();
        this.selected = 0;
        POSITION.forEach((id, axis) =>
            byId(id).addEventListener("change", ({ target }) => this._sendPosition(axis, typed(target))),
        );
        FREE.forEach((id, axis) => byId(id).addEventListener("click", () => this._turnFree(AXES[axis])));
        TURN.forEach((id, axis) =>
            byId(id).addEventListener("change", ({ target }) => this._sendTurn(axis, typed(target))),
        );
        byId("orientation").addEventListener("change", ({ target }) => this._orient({ on: target.checked }));
        byId("add-effector").addEventListener("change", ({ target }) => {
            if (target.value) connection.send({ type: "add_effector", frame: target.value });
            target.value = "";
        });
    }

    get ball() {
        return this.state?.balls[this.selected];
    }

    setRobot(robot) {
        this._frames = robot.frames;
        this.selected = 0;
    }

    setState(state) {
        this.state = state;
        if (this.selected >= state.balls.length) this.select(Math.max(0, state.balls.length - 1));
        const taken = new Set(state.balls.map(({ frame }) => frame));
        offer(byId("add-effector"), [
            ["", "Add a ball …"],
            ...this._frames.filter((frame) => !taken.has(frame)).map((frame) => [frame, frame]),
        ]);
        while (this._rows.length > state.balls.length) this._rows.pop().row.remove();
        while (this._rows.length < state.balls.length) this._rows.push(this._make(this._rows.length));
        this._rows.forEach((row, k) => this._showRow(row, state.balls[k], k));
        this._showNumbers();
    }

    _make(k) {
        const pick = make(
            "button",
            { type: "button", className: "pick", dataset: { testid: `ball-${k}` } },
            make("span", { className: "dot" }),
            make("span"),
        );
        pick.addEventListener("click", () => this.select(k));
        const mode = make("select", { className: "small", dataset: { testid: `ball-mode-${k}` } });
        offer(mode, MODES);
        mode.addEventListener("change", () => this._connection.send({ type: "effector", index: k, mode: mode.value }));
        const remove = make(
            "button",
            { type: "button", className: "quiet", dataset: { testid: `ball-remove-${k}` } },
            icon("close"),
        );
        remove.addEventListener("click", () => this._connection.send({ type: "remove_effector", index: k }));
        const row = make("li", {}, pick, mode, remove);
        byId("balls").append(row);
        return { row, pick, mode, remove };
    }

    _showRow({ row, pick, mode, remove }, ball, k) {
        say(pick.lastChild, ball.frame);
        pick.ariaPressed = String(k === this.selected);
        mode.ariaLabel = `Mode of the ball of ${ball.frame}`;
        remove.ariaLabel = `Remove the ball of ${ball.frame}`;
        remove.disabled = this._rows.length === 1;
        remove.title = remove.disabled ? "The last ball stays; switch it off instead" : remove.ariaLabel;
        row.dataset.mode = ball.mode;
        write(mode, ball.mode);
    }

    /** Show an orientation that a ring has given, without waiting for the session. */
    turned(k, rpy) {
        this._asked.ask(`orientation ${k}`, { on: true, rpy });
        if (k !== this.selected) return;
        TURN.forEach((id, axis) => {
            write(byId(id), plain(rpy[axis] / DEGREE, 1));
        });
    }

    /** Show a ball's position after a drag without waiting for the session. */
    moved(k, position) {
        this._asked.ask(`position ${k}`, position);
        this._showPosition(k, position);
    }

    _showPosition(k, position) {
        if (k !== this.selected) return;
        POSITION.forEach((id, axis) => write(byId(id), plain(position[axis], 3)));
    }

    _showNumbers() {
        const { ball } = this;
        for (const id of [...POSITION, ...FREE, ...TURN, "orientation"]) byId(id).disabled = !ball;
        if (!ball) return;
        this._showPosition(this.selected, ball.position);
        this._showFree(ball);
        write(byId("orientation"), ball.oriented);
        TURN.forEach((id, axis) => {
            write(byId(id), plain(ball.rpy[axis] / DEGREE, 1));
        });
        byId("turns").hidden = byId("ring-axes").hidden = !ball.oriented;
    }

    /** Show which axes are free. Something must stay asked for, so the last switch that would end that is disabled. */
    _showFree({ free, oriented }) {
        AXES.forEach((axis, k) => {
            const button = byId(FREE[k]);
            const isFree = free.includes(axis);
            button.ariaPressed = String(isFree);
            button.disabled = !isFree && !oriented && free.length === 2;
            button.title = isFree ? `Any ${axis} will do; click to ask for this one` : `Leave ${axis} free`;
            byId(POSITION[k]).classList.toggle("faint", isFree);
        });
        if (free.length === 3) byId("orientation").disabled = true;
    }

    select(k) {
        this.selected = k;
        this._rows.forEach(({ pick }, j) => {
            pick.ariaPressed = String(j === k);
        });
        this._onSelect(k);
        this._showNumbers();
    }

    selectNext() {
        if (this._rows.length) this.select((this.selected + 1) % this._rows.length);
    }

    toggleOrientation() {
        if (this.ball) this._orient({ on: !this.ball.oriented });
    }

    _sendPosition(axis, value) {
        if (value === null || !this.ball) return;
        const key = `position ${this.selected}`;
        const position = changed(this._asked.now(key, this.ball.position), axis, value);
        this._connection.send({ type: "ball", index: this.selected, position: this._asked.ask(key, position) });
    }

    _turnFree(axis) {
        const key = `free ${this.selected}`;
        const before = this._asked.now(key, this.ball.free);
        const axes = AXES.filter((own) => before.includes(own) !== (own === axis)).join("");
        this._connection.send({ type: "free", index: this.selected, axes: this._asked.ask(key, axes) });
    }

    _sendTurn(axis, value) {
        if (value !== null && this.ball) this._orient({ axis, angle: value * DEGREE });
    }

    /** Switch the orientation on or off, or change one of its angles. */
    _orient({ on, axis, angle }) {
        const key = `orientation ${this.selected}`;
        const before = this._asked.now(key, { on: this.ball.oriented, rpy: this.ball.rpy });
        const rpy = axis === undefined ? before.rpy : changed(before.rpy, axis, angle);
        const asked = this._asked.ask(key, { on: on ?? before.on, rpy });
        this._connection.send({ type: "orientation", index: this.selected, ...asked });
    }
}

function changed(numbers, index, value) {
    return numbers.map((old, i) => (i === index ? value : old));
}
