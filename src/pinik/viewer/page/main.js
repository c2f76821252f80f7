/** The live page: connects the session's messages with the picture, the panel and the user's input. */

import { Address } from "pinik/address.js";
import { Answers } from "pinik/answers.js";
import { Cards } from "pinik/cards.js";
import { Charts } from "pinik/charts.js";
import { Connection } from "pinik/connection.js";
import { Controls } from "pinik/controls.js";
import { Copying } from "pinik/copying.js";
import { byId } from "pinik/elements.js";
import { makeSearchable } from "pinik/finder.js";
import { isFrame } from "pinik/frame.js";
import { Handles } from "pinik/handles.js";
import { watchHands } from "pinik/hands.js";
import { inspector } from "pinik/inspector.js";
import { Joints } from "pinik/joints.js";
import { Keys } from "pinik/keys.js";
import { Lectern } from "pinik/lectern.js";
import { LookMenu } from "pinik/look_menu.js";
import { Notices } from "pinik/notices.js";
import { openWithRobots } from "pinik/opening.js";
import { PictureDialog } from "pinik/picture.js";
import { Presentation } from "pinik/presentation.js";
import { addPresets } from "pinik/presets.js";
import { RingAxes } from "pinik/ring_axes.js";
import { shortcuts } from "pinik/shortcuts.js";
import { Show } from "pinik/show.js";
import { Surroundings } from "pinik/surroundings.js";
import { Table } from "pinik/table.js";
import { Targets } from "pinik/targets.js";
import { Theme } from "pinik/theme.js";
import { Undo } from "pinik/undo.js";

class Page {
    constructor() {
        watchHands(() => this.state && this._showSettings(this.state));
        this.theme = new Theme();
        this.notices = new Notices();
        // First, so that the server answers while the page is being built.
        this.connection = new Connection({
            onText: (message) => this._on[message.type]?.(message),
            onBinary: (buffer) => this._take(buffer),
            onOpen: () => this.notices.connected(true),
            onClose: () => this.notices.connected(false),
        });
        this.show = new Show({ canvas: byId("canvas"), labels: byId("labels") }, this.theme);
        this.controls = new Controls(this.connection, this.notices);
        this.cards = new Cards(byId("cards"), this.connection);
        this.targets = new Targets(this.connection, (k) => this.show.select(k));
        this.surroundings = new Surroundings(byId("surroundings"), this.connection);
        this.answers = new Answers(byId("answers"), this.connection, this.show);
        this.table = new Table(byId("table"), this.connection);
        this.joints = new Joints(this.connection);
        this.undo = new Undo(this.connection);
        this.copying = new Copying(this.connection, this.joints);
        this.picture = new PictureDialog(this.show, this.theme);
        this.lookMenu = new LookMenu(this.connection);
        const own = (name) => (value) => this.address?.showOwn(name, value);
        this.presentation = new Presentation((on) => own("present")(on ? "on" : ""));
        this.ringAxes = new RingAxes((choice) => {
            own("rings")(choice === "world" ? choice : "");
            this.show.stage.touch();
        });
        this.lectern = new Lectern(this, own("learn"));
        this.address = new Address((setup) => this.connection.send({ type: "setup", setup }), {
            present: (value) => this.presentation.turn(value === "on"),
            rings: (value) => this.ringAxes.choose(value === "world" ? value : "local"),
            learn: (value) => this.lectern.open(value),
        });
        makeSearchable(byId("robot"), "Search robots");
        makeSearchable(byId("add-effector"), "Search frames");
        this.charts = new Charts(this.theme);
        this.handles = new Handles(this);
        this._unanswered = [];
        Object.assign(this._on, this.lectern.handlers);
        this._makeButtons();
        openWithRobots(this.show, byId("app"));
        new Keys(shortcuts(this));
        this.show.stage.onTick((now) => this._tick(now));
        document.addEventListener("visibilitychange", () => this._answer());
    }

    /** The handlers of the session's messages. */
    _on = {
        hello: (hello) => {
            this._lost = this.hello && this.hello.server !== hello.server ? this.state : null;
            this.hello = hello;
            for (const part of [this.show, this.controls, this.cards, this.table, this.lookMenu, this.lectern]) part.setHello(hello);
        },
        robot: (robot) => {
            this.show.setRobot(robot);
            for (const part of [this.targets, this.joints, this.undo, this.surroundings]) part.setRobot(robot);
            this.answers.clear();
            this.notices.clear();
            this.lectern.setRobot();
            this.notices.warnings(robot.warnings);
            this.robot = robot;
            this._restore();
            this._showLoading();
        },
        state: (state) => {
            this.state = state;
            this.undo.setState(state);
            document.title = `${state.robot} – pinik`;
            this._showSettings(state);
            this.charts.setState(state);
            this.show.setState(state);
            this.table.setState(state, this.show.awaiting);
            this.handles.setState(state);
            this.answers.setState(state);
            this._showLoading();
            this.notices.watched(state.watched);
            this.lectern.setState(state);
            this.address.show(state.setup);
        },
        shapes: (shapes) => {
            const notes = this.show.setShapes(shapes);
            if (this.state) this.table.setState(this.state, this.show.awaiting);
            this.controls.setShapes(shapes);
            if (shapes.generation === this.robot.generation)
                this.notices.warnings([...this.robot.warnings, ...shapes.warnings, ...notes]);
            for (const note of notes) this.notices.error(note);
            this._showLoading();
        },
        collisions: (message) => {
            if (message.generation !== this.robot.generation) return;
            this.show.look.setCollisions(message);
            for (const warning of message.warnings) this.notices.error(warning);
        },
        reach: (message) => {
            if (message.generation === this.robot.generation) this.show.look.setReach(message);
        },
        answers: (answers) => answers.generation === this.robot.generation && this.answers.showAll(answers),
        self_motion: (motion) => motion.generation === this.robot.generation && this.answers.showMotion(motion),
        error: ({ message }) => {
            this.notices.error(message);
            this.lectern.fail();
            this.answers.fail();
        },
    };

    /** Give a server that was started again, with the same robot, the set-up that the last one had. */
    _restore() {
        if (this._lost?.robot === this.robot.name) this.connection.send({ type: "setup", setup: this._lost.setup });
        this._lost = null;
    }

    _showSettings(state) {
        const parts = [this.controls, this.cards, this.targets, this.joints, this.surroundings, this.lookMenu];
        for (const part of parts) part.setState(state);
    }

    /** Say which robot, or whose shapes, are being loaded. */
    _showLoading() {
        const { loading } = this.state ?? {};
        if (loading) this.notices.loading(`Loading ${loading} …`);
        else this.notices.loading(this.show.awaiting ? `Loading the shapes of ${this.robot.name} …` : "");
    }

    _take(buffer) {
        const bytes = new Uint8Array(buffer);
        if (!isFrame(bytes)) {
            this.show.command(bytes);
            return;
        }
        const frame = this.show.setFrame(buffer);
        this.charts.add(frame, frame.step / this.hello.steps_per_second);
        // A hidden page draws nothing but still answers.
        this._unanswered.push(frame.step);
        if (document.hidden) this._answer();
    }

    _answer() {
        for (const step of this._unanswered.splice(0)) this.connection.send({ type: "drawn", step });
    }

    _tick(now) {
        this._answer();
        this.charts.tick(now);
    }

    _makeButtons() {
        addPresets(byId("presets"), this.show);
        byId("frame-all").addEventListener("click", () => this.show.frameAll());
        byId("help-button").addEventListener("click", () => byId("help").showModal());
        byId("help").addEventListener("click", ({ target }) => target === byId("help") && byId("help").close());
        byId("theme").addEventListener("click", () => this.theme.turn());
        const tell = () => {
            byId("theme").title = `Theme: ${this.theme.choice} (t)`;
        };
        this.theme.addEventListener("change", tell);
        tell();
    }
}

window.pinik = inspector(new Page());
