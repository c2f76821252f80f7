/** The settings that all instances share. */

import { byId, make, say } from "pinik/elements.js";
import { Asked, offer, scale, typed, write } from "pinik/hands.js";
import { ANGLES, LENGTHS, measured, outside } from "pinik/units.js";
import { plain, spaced } from "pinik/words.js";

const DEGREE = Math.PI / 180;

export class Controls {
    /** @param connection sends the messages; notices says what is wrong with an input, and how to start again */
    constructor(connection, notices) {
        this._connection = connection;
        this._notices = notices;
        const send = (type, fields) => connection.send({ type, ...fields });
        this._send = send;
        this._asked = new Asked();
        for (const id of ["robot", "root"]) {
            byId(id).addEventListener("change", () =>
                send("robot", { name: byId("robot").value, root: byId("root").value }),
            );
        }
        byId("motion").addEventListener("change", ({ target }) => send("motion", { motion: target.value }));
        byId("curve").addEventListener("change", ({ target }) => send("curve", { curve: target.value }));
        byId("limits").addEventListener("change", ({ target }) => send("limits", { on: target.checked }));
        byId("pause-on-miss").addEventListener("change", ({ target }) =>
            send("pause_on_miss", { on: target.checked }),
        );
        byId("polish").addEventListener("change", ({ target }) => send("polish", { on: target.checked }));
        byId("start").addEventListener("click", () => this.toggleRun());
        byId("step").addEventListener("click", () => this.step());
        byId("reset").addEventListener("click", () => send("reset"));
        this._bindSpeed();
        this._bindIterations();
        this._bindTolerance();
    }

    setHello(hello) {
        this.hello = hello;
        const titled = (list) => list.map(({ name, title }) => [name, title]);
        offer(
            byId("robot"),
            hello.robots.map((name) => [name, name]),
        );
        offer(
            byId("root"),
            hello.roots.map((name) => [name, spaced(name)]),
        );
        offer(byId("motion"), titled(hello.motions));
        offer(byId("curve"), titled(hello.curves));
        const [low, high] = hello.ranges.speed;
        this._speed = scale(low, high, true);
        Object.assign(byId("speed"), { min: low, max: high });
        [byId("iterations").min, byId("iterations").max] = hello.ranges.iterations;
        byId("views").replaceChildren(...hello.views.map((count) => this._viewButton(count)));
    }

    _viewButton(count) {
        const title = count === 1 ? "One robot (1)" : `${count} robots side by side (${count})`;
        const button = make(
            "button",
            { type: "button", title, dataset: { testid: `view-${count}`, view: count } },
            String(count),
        );
        button.addEventListener("click", () => this.view(count));
        return button;
    }

    view(count) {
        this._send("view", { count });
    }

    toggleRun() {
        this._send("run", { on: !this.state?.running });
    }

    /** Make one step; a running session stops first. */
    step() {
        if (this.state?.running) this._send("run", { on: false });
        this._send("step");
    }

    changeSpeed(factor) {
        const [low, high] = this.hello.ranges.speed;
        this._send("speed", { value: Number(Math.min(Math.max(this.state.speed * factor, low), high).toPrecision(3)) });
    }

    _bindSpeed() {
        byId("speed").addEventListener("change", ({ target }) => {
            const value = typed(target);
            if (value !== null) this._send("speed", { value });
        });
        byId("speed-slider").addEventListener("input", ({ target }) => {
            const value = this._speed.value(Number(target.value));
            byId("speed").value = plain(value);
            this._connection.sendNewest("speed", { type: "speed", value });
        });
    }

    _bindIterations() {
        const send = (change) => this._sendPart("iterations", change);
        byId("iterations").addEventListener("change", ({ target }) => {
            const value = typed(target);
            if (value !== null) send({ at_most: Math.round(value) });
        });
        byId("until-reached").addEventListener("change", ({ target }) => send({ until_reached: target.checked }));
    }

    _bindTolerance() {
        for (const [id, name, units, unit] of [
            ["tolerance", "position", LENGTHS, "mm"],
            ["tolerance-angle", "orientation", ANGLES, "°"],
        ]) {
            byId(id).addEventListener("change", ({ target }) => {
                const value = measured(target.value, units, unit);
                const fault = outside(value, this.hello.ranges[`${name}_tolerance`], units, unit);
                if (fault) this._notices.error(`The tolerance must be ${fault}; got "${target.value.trim()}".`);
                else this._sendPart("tolerance", { [name]: value });
            });
        }
    }

    /** Change part of a setting that is sent as a whole. */
    _sendPart(type, change) {
        this._send(type, this._asked.ask(type, { ...this._asked.now(type, this.state[type]), ...change }));
    }

    setState(state) {
        this.state = state;
        const { hello } = this;
        this._notices.setCommand(state.command);
        // A robot from the user's own file is not in the catalogue.
        if (!hello.robots.includes(state.robot))
            offer(
                byId("robot"),
                [state.robot, ...hello.robots].map((name) => [name, name]),
            );
        for (const name of ["robot", "root", "motion", "curve"]) write(byId(name), state[name]);
        write(byId("limits"), state.limits);
        write(byId("polish"), state.polish);
        write(byId("pause-on-miss"), state.pause_on_miss);
        byId("missed").hidden = !state.missed;
        say(byId("missed"), state.missed ? `Paused: ${state.missed}` : "");
        write(byId("speed"), plain(state.speed));
        write(byId("speed-slider"), this._speed.position(state.speed));
        write(byId("until-reached"), state.iterations.until_reached);
        write(byId("iterations"), state.iterations.at_most);
        byId("iterations").closest(".field").classList.toggle("faint", state.iterations.until_reached);
        write(byId("tolerance"), plain(state.tolerance.position * 1000));
        write(byId("tolerance-angle"), plain(Number((state.tolerance.orientation / DEGREE).toPrecision(3))));
        for (const button of byId("views").children)
            button.ariaPressed = String(Number(button.dataset.view) === state.view);
        byId("curve")
            .closest(".field")
            .classList.toggle("faint", state.motion !== "curve");
        this._showRun(state);
        const file = `pinik-${state.robot.replace(/[^\w-]+/g, "_")}`;
        byId("save-animation").download = `${file}.html`;
        byId("save-glb").download = `${file}.glb`;
    }

    setShapes({ parts }) {
        byId("save-glb").hidden = !parts.length;
    }

    _showRun({ running, steps_per_second: rate }) {
        const start = byId("start");
        start.title = running ? "Stop (space)" : "Start (space)";
        start.querySelector("use").setAttribute("href", running ? "#icon-pause" : "#icon-play");
        say(start.querySelector("span"), running ? "Stop" : "Start");
        say(byId("rate"), running && rate ? `${rate.toFixed(0)} steps/s` : running ? "" : "stopped");
    }
}
