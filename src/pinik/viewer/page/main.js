/** The live page: connects the session's messages with the picture, the panel and the user's input. */

import { Address } from "pinik/address.js";
import { Answers } from "pinik/answers.js";
import { Cards } from "pinik/cards.js";
import { Chart } from "pinik/chart.js";
import { Connection } from "pinik/connection.js";
import { Copying } from "pinik/copying.js";
import { Controls } from "pinik/controls.js";
import { byId } from "pinik/elements.js";
import { Lectern } from "pinik/lectern.js";
import { isFrame } from "pinik/frame.js";
import { Grab } from "pinik/grab.js";
import { watchHands } from "pinik/hands.js";
import { makeSearchable } from "pinik/finder.js";
import { History } from "pinik/history.js";
import { Joints } from "pinik/joints.js";
import { Keys } from "pinik/keys.js";
import { LookMenu } from "pinik/look_menu.js";
import { Notices } from "pinik/notices.js";
import { Nudge } from "pinik/nudge.js";
import { Obstacles } from "pinik/obstacles.js";
import { PictureDialog } from "pinik/picture.js";
import { Presentation } from "pinik/presentation.js";
import { addPresets } from "pinik/presets.js";
import { RingAxes } from "pinik/ring_axes.js";
import { Rings } from "pinik/rings.js";
import { shortcuts } from "pinik/shortcuts.js";
import { Show } from "pinik/show.js";
import { Surroundings } from "pinik/surroundings.js";
import { Table } from "pinik/table.js";
import { Targets } from "pinik/targets.js";
import { Theme } from "pinik/theme.js";
import { THREE } from "pinik/three.js";
import { Undo } from "pinik/undo.js";
import { length, microseconds } from "pinik/words.js";

const CHARTS = 100; // [ms] between two drawings of the charts
const PATIENCE = 1000; // [ms] until the page is shown without robots; as in stage.css

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
            onClose: () => this.notices.connected(false, this.state?.robot),
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
        this.history = new History();
        this._drawnCharts = 0;
        this._unanswered = [];
        Object.assign(this._on, this.lectern.handlers);
        this._makeCharts();
        this._makeHands();
        this._makeButtons();
        this._waitForRobots();
        new Keys(shortcuts(this));
        this.show.stage.onTick((now) => this._tick(now));
        document.addEventListener("visibilitychange", () => this._answer());
    }

    /** The handlers of the session's messages. */
    _on = {
        hello: (hello) => {
            this.hello = hello;
            for (const part of [this.show, this.controls, this.cards, this.table, this.lookMenu, this.lectern]) part.setHello(hello);
        },
        robot: (robot) => {
            this.show.setRobot(robot);
            for (const part of [this.targets, this.joints, this.undo, this.surroundings]) part.setRobot(robot);
            this.answers.clear();
            this.lectern.setRobot();
            this.notices.warnings(robot.warnings);
            this.robot = robot;
            this._showLoading();
        },
        state: (state) => {
            this.state = state;
            this.undo.setState(state);
            document.title = `${state.robot} – pinik`;
            this._showSettings(state);
            for (const part of [this.table, this._errorChart, this._timeChart]) part.setState(state);
            this.show.setState(state);
            this.obstacles.setState(state);
            this.answers.setState(state);
            this._showLoading();
            this.notices.watched(state.watched);
            this.lectern.setState(state);
            this.address.show(state.setup);
        },
        shapes: (shapes) => {
            const notes = this.show.setShapes(shapes);
            if (shapes.generation === this.robot.generation)
                this.notices.warnings([...this.robot.warnings, ...shapes.warnings, ...notes]);
            for (const note of notes) this.notices.error(note);
            this._showLoading();
        },
        collisions: (message) => {
            if (message.generation === this.robot.generation) this.show.look.setCollisions(message);
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

    /** Draw nothing before the robots are there: a processor that draws the page then draws one picture, not twenty. */
    _waitForRobots() {
        const { stage } = this.show;
        stage.held = true;
        const open = () => {
            stage.held = false;
            byId("app").classList.remove("starting");
        };
        this.show.onComplete = open;
        setTimeout(open, PATIENCE);
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
        this.history.add(frame, frame.step / this.hello.steps_per_second);
        // A hidden page draws nothing but still answers.
        this._unanswered.push(frame.step);
        if (document.hidden) this._answer();
    }

    _answer() {
        for (const step of this._unanswered.splice(0)) this.connection.send({ type: "drawn", step });
    }

    _tick(now) {
        this._answer();
        if (now - this._drawnCharts < CHARTS || !this.state) return;
        this._drawnCharts = now;
        const { tolerance } = this.state;
        this._errorChart.draw(this.history, tolerance.position * 1000);
        this._timeChart.draw(this.history, null);
    }

    _makeCharts() {
        this._errorChart = new Chart(byId("error-chart"), this.theme, {
            value: ({ error }) => error * 1000,
            words: (millimetres) => length(millimetres / 1000),
            decades: 4,
        });
        this._timeChart = new Chart(byId("time-chart"), this.theme, {
            value: ({ seconds }) => seconds * 1e6,
            words: (micros) => microseconds(micros / 1e6),
            decades: 2,
        });
    }

    _makeHands() {
        // Before the balls, so that a ring beside a ball is taken first.
        this.rings = new Rings(this.show, {
            selected: () => this.targets.selected,
            local: () => this.ringAxes.choice === "local",
            onTurn: (index, rpy) => {
                this.connection.sendNewest(`turn ${index}`, { type: "orientation", index, on: true, rpy });
                this.targets.turned(index, rpy);
            },
            onDrop: (index) => this.connection.flush(`turn ${index}`),
        });
        this.grab = new Grab(this.show, {
            onGrab: (k) => this.targets.select(k),
            onMove: (k, position) => this._moveBall(k, position),
            onDrop: (k) => this.connection.flush(`ball ${k}`),
            onHover: (k) => this.show.pointAt(k),
        });
        this.obstacles = new Obstacles(this.show);
        const moved = (index, position) =>
            this.connection.sendNewest(`obstacle ${index}`, { type: "obstacle", index, position });
        const nothing = () => {};
        const drop = (k) => this.connection.flush(`obstacle ${k}`);
        const hands = { onGrab: nothing, onMove: moved, onDrop: drop, onHover: nothing };
        this.obstacleGrab = new Grab(this.obstacles, hands, "over-obstacle");
        this.nudge = new Nudge(this.show, (k, position) => {
            this.show.balls.hold(k, new THREE.Vector3(...position));
            this.show.letGoOfBall(k);
            this._moveBall(k, position);
        });
    }

    _moveBall(index, position) {
        this.connection.sendNewest(`ball ${index}`, { type: "ball", index, position });
        this.targets.moved(index, position);
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

const page = new Page();

/** For tests, and for the browser's console. */
window.pinik = {
    get state() {
        return page.state;
    },
    get table() {
        return page.table;
    },
    get viewer() {
        return page.show.stage.viewer;
    },
    get show() {
        return page.show;
    },
    get frames() {
        return page.show.stage.frames;
    },
    /** What has been drawn of the current robot: "", "skeleton" or "shapes". */
    get drawn() {
        return page.show.drawn;
    },
    get ready() {
        return page.show.drawn !== "";
    },
    /** Whether the camera has come to rest. */
    get still() {
        return page.show.still;
    },
    /** Whether the picture has stopped changing and has been drawn in full detail. */
    get settled() {
        return page.show.stage.settled;
    },
    /** The middle of one side of a ring around the selected ball in the first instance, as `targetOnScreen`. */
    ringOnScreen(axis, angle) {
        return page.rings.onScreen(axis, angle);
    },
    /** The position of ball k in the first instance, in CSS pixels of the page. */
    targetOnScreen(k) {
        const { stage } = page.show;
        const box = stage.element.getBoundingClientRect();
        const { x, y } = stage.project(page.show.ballInWorld(k, 0));
        return { x: box.left + x, y: box.top + y };
    },
};
