/** Everything in the 3-D picture, as the session's messages say it; the live page and a saved one share it. */

import { Balls } from "pinik/balls.js";
import { Camera } from "pinik/camera.js";
import { Frame } from "pinik/frame.js";
import { Instance } from "pinik/instance.js";
import { Labels } from "pinik/labels.js";
import { Shapes } from "pinik/shapes.js";
import { Stage } from "pinik/stage.js";
import { THREE } from "pinik/three.js";
import { verdict } from "pinik/words.js";

const BALL = 0.027; // its radius, of the robot's size
const WANDERED = 700; // [ms] out of the picture before the camera follows
const LABELS = 120; // [ms] between two changes of the labels' words

export class Show {
    constructor({ canvas, labels }, theme) {
        this.stage = new Stage(canvas, theme);
        this.camera = new Camera(this.stage);
        this.balls = new Balls();
        this._theme = theme;
        this._shapes = new Shapes(this.stage.viewer);
        this._labels = new Labels(labels);
        this._instances = [];
        this._statuses = [];
        this._selected = 0;
        this._near = null;
        this._labelled = 0;
        this._seenSince = 0;
        this.drawn = "";
        theme.addEventListener("change", () => this._paint());
        this.camera.addEventListener("offsets", () => this._moveInstances());
        this.stage.onTick((now) => this._tick(now));
        this.stage.onResize = () => this.camera.moved || this.frameAll(false);
        this.stage.onRefine = (fine) => this._instances.forEach(({ robot }) => robot.refine(fine));
        this.stage.onDrawn = () => this._afterDrawing();
    }

    setHello(hello) {
        this._statuses = hello.statuses;
    }

    setRobot(robot) {
        for (const instance of this._instances) instance.dispose();
        this._instances = [];
        this._shapes.clear();
        this.balls.forget();
        Object.assign(this, { robot, drawn: "", _parts: null, _frame: null, _ground: null, _framed: 0 });
        this.stage.touch();
    }

    command(bytes) {
        this._shapes.command(bytes);
    }

    setShapes(message) {
        if (message.generation !== this.robot?.generation || !message.parts.length) return;
        this._parts = this._shapes.parts(message);
        for (const instance of this._instances) instance.setRobot(this.robot, this._parts, this.stage.fine);
        this._ground = null;
        this.drawn = "";
        if (this._frame) this._draw(this._frame);
        if (!this.camera.moved) this.frameAll(this._framed > 0);
    }

    setState(state) {
        const before = this.state;
        this.state = state;
        this._selected = Math.min(this._selected, Math.max(0, state.balls.length - 1));
        this._showBalls();
        const asked = ({ balls, motion, curve, view }) => [motion, curve, view, balls.map((ball) => ball.mode + ball.frame)].join();
        if (before && this._framed && asked(before) !== asked(state)) this._reframe = true;
        this.stage.touch();
    }

    _showBalls() {
        if (!this.state || !this.robot) return;
        for (const instance of this._instances) {
            instance.setState(this.state, BALL * this.robot.size, this._selected, this._near);
        }
        this.stage.touch();
    }

    /** The newest frame; drawn with the next picture. */
    setFrame(buffer) {
        const frame = new Frame(buffer);
        if (frame.generation !== this.robot?.generation || !this.state || frame.balls !== this.state.balls.length) return frame;
        this._next = frame;
        return frame;
    }

    _tick(now) {
        if (this._next) {
            const frame = this._next;
            this._next = null;
            const moves = !frame.looksLike(this._frame) || this._instances.some((instance) => instance.fading);
            this._frame = frame;
            if (moves || frame.instances !== this._instances.length) this._draw(frame);
            this._label(now);
        }
        if (this._reframe && this._frame?.instances === this.state.view && !this.busy) {
            this._reframe = false;
            this.frameAll();
        }
        this._followWanderers(now);
    }

    _draw(frame) {
        while (this._instances.length > frame.instances) this._instances.pop().dispose();
        while (this._instances.length < frame.instances) this._addInstance();
        this.balls.take(frame);
        for (const instance of this._instances) instance.update(frame, this.balls.places);
        if (this._ground === null) this._ground = Math.min(...this._instances[0].robot.corners().map((corner) => corner.z));
        if (this._framed !== frame.instances) {
            this._framed = frame.instances;
            this.frameAll();
        }
        this.stage.touch();
    }

    _addInstance() {
        const instance = new Instance(this.stage.scene, this._instances.length, this._theme);
        instance.setRobot(this.robot, this._parts, this.stage.fine);
        this._instances.push(instance);
        this._showBalls();
        this._moveInstances();
    }

    _moveInstances() {
        this._instances.forEach((instance, i) => instance.group.position.copy(this.offset(i)));
    }

    /** Where instance `i` stands: a Vector3. */
    offset(i) {
        return this.camera.offsets[i] ?? new THREE.Vector3();
    }

    /** Look at everything; the camera goes there smoothly unless told otherwise. */
    frameAll(smoothly = true, preset = this.camera.preset) {
        if (!this._frame || !this._instances.length) return;
        this.camera.frame(this._extent(), this._frame.instances, preset, smoothly);
        const { center, radius } = this.camera.sphere;
        this.stage.ground.lay(this._ground, center.x, center.y, radius, this.robot.size);
    }

    /** What of each instance should be in the picture, as points. */
    _extent() {
        const points = this._instances.flatMap((instance) => instance.robot.corners());
        const room = 1.2 * BALL * this.robot.size;
        this.state.balls.forEach((ball, k) => {
            if (ball.mode === "off") return;
            const { position } = this.balls.places[k];
            for (const side of [-room, room]) points.push(position.clone().addScalar(side));
            for (let j = 0; j < ball.curve.length; j += 4) points.push(new THREE.Vector3(...ball.curve[j]));
        });
        this._base = this._instances[0].robot.corners().filter((corner) => corner.z < this._ground + 0.12 * this.robot.size);
        return points;
    }

    /** Something is in the visitor's hand: the camera stays. */
    get busy() {
        return Boolean(this.held);
    }

    /** Where a ball or robot left the picture for good, and the visitor has not turned the camera, look at all again. */
    _followWanderers(now) {
        if (!this._frame || this.busy || this.camera.moved || !this._framed || this.balls.count !== this.state.balls.length) return;
        const outside = this.ballsOnScreen().some(({ at }) => at.x < 0 || at.y < 0 || at.x > this.stage.width || at.y > this.stage.height);
        if (!outside) this._seenSince = now;
        else if (now - this._seenSince > WANDERED) {
            this._seenSince = now;
            this.frameAll();
        }
    }

    _label(now) {
        if (now - this._labelled < LABELS) return;
        this._labelled = now;
        const { instances, tolerance } = this.state;
        this._labels.set(
            instances.slice(0, this._frame.instances).map(({ title }, i) => {
                const { status, positionError, orientationError } = this._frame.figures(i);
                const name = this._statuses[status];
                return { title, words: verdict(name, positionError, orientationError, tolerance), good: name === "CONVERGED" };
            }),
        );
        this._placeLabels();
    }

    _placeLabels() {
        if (!this._base?.length) return;
        const anchors = this._instances.map((_, i) => {
            const seen = this._base.map((corner) => this.stage.project(corner.clone().add(this.offset(i))));
            const xs = seen.map(({ x }) => x);
            return {
                x: (Math.min(...xs) + Math.max(...xs)) / 2,
                y: Math.max(...seen.map(({ y }) => y)) + 8,
                behind: seen.some(({ behind }) => behind),
            };
        });
        this._labels.place(anchors, this.stage.width, this.stage.height);
    }

    _afterDrawing() {
        if (this._instances.length && this._frame && !this.drawn) this.drawn = this._parts ? "shapes" : "skeleton";
        this._placeLabels();
    }

    _paint() {
        for (const instance of this._instances) instance.paint();
        this.stage.touch();
    }

    select(k) {
        this._selected = k;
        this._showBalls();
    }

    pointAt(k) {
        if (k === this._near) return;
        this._near = k;
        this._showBalls();
    }

    holdBall(k, position) {
        this.held = true;
        this.balls.hold(k, position);
        if (this._frame) this._draw(this._frame);
    }

    letGoOfBall(k) {
        this.held = false;
        this.balls.letGo(k);
    }

    /** A frame that is not shown itself, but has been on the way. */
    addToTrails(buffer) {
        const frame = new Frame(buffer);
        for (const instance of this._instances) instance.addToTrails(frame);
    }

    clearTrails() {
        for (const instance of this._instances) instance.clearTrails();
    }

    /** A ball's copy in the scene, z up. */
    ballInWorld(k, instance) {
        return this.balls.places[k].position.clone().add(this.offset(instance));
    }

    /** Every copy of every ball that is shown: {k, instance, at, radius}, in pixels of the canvas. */
    ballsOnScreen() {
        if (!this.state || !this.robot) return [];
        const { camera, controls } = this.stage.viewer;
        const pixel = (2 * camera.position.distanceTo(controls.target) * Math.tan((camera.fov * Math.PI) / 360)) / this.stage.height;
        const radius = (BALL * this.robot.size) / pixel;
        return this._instances.flatMap((_, instance) =>
            this.balls.places.flatMap((_place, k) => {
                if (this.state.balls[k]?.mode === "off") return [];
                return [{ k, instance, radius, at: this.stage.project(this.ballInWorld(k, instance)) }];
            }),
        );
    }
}
