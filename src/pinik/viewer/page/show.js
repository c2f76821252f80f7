/** Everything in the 3-D picture, controlled by the session's messages. The live page and saved animations share it. */

import { Balls } from "pinik/balls.js";
import { Camera } from "pinik/camera.js";
import { Captions } from "pinik/captions.js";
import { Extent } from "pinik/extent.js";
import { Frame } from "pinik/frame.js";
import { Instance } from "pinik/instance.js";
import { Look } from "pinik/look.js";
import { ballsOnScreen } from "pinik/on_screen.js";
import { Pointers } from "pinik/pointers.js";
import { lighten, Shapes } from "pinik/shapes.js";
import { Sight } from "pinik/sight.js";
import { Stage } from "pinik/stage.js";
import { THREE } from "pinik/three.js";

const BALL = 0.025; // radius, as a fraction of the robot's size
const BASE = 0.12; // as a fraction of the robot's size: the robot stands on what is lower than this above the ground

export class Show {
    /** @param options played: whether the frames are a recording, whose results no state tells */
    constructor({ canvas, labels }, theme, { played = false } = {}) {
        this._played = played;
        this.stage = new Stage(canvas, theme);
        this.camera = new Camera(this.stage);
        this.balls = new Balls();
        this._theme = theme;
        this._shapes = new Shapes(this.stage.viewer, "shapes");
        [this.instances, this.base, this.also] = [[], [], []];
        this._captions = new Captions(labels, this);
        this._pointers = new Pointers(labels, this);
        this.look = new Look(labels, this);
        this._selected = 0;
        [this._near, this._busy] = [null, false];
        this._sight = new Sight(this);
        this.drawn = "";
        theme.addEventListener("change", () => this._paint());
        this.camera.addEventListener("offsets", () => this._moveInstances());
        this.stage.onTick((now) => this._tick(now));
        this.stage.onResize = () => !this.camera.moved && this.frameAll(false);
        this.stage.onRefine = (fine) => this.instances.forEach(({ robot }) => robot.refine(fine));
        this.stage.onDrawn = () => this._afterDrawing();
    }

    setHello(hello) {
        this._captions.setHello(hello);
    }

    setRobot(robot) {
        for (const instance of this.instances) instance.dispose();
        this.instances = [];
        this._shapes.clear();
        this.look.forget();
        this.balls.forget();
        this._sight.forget();
        Object.assign(this, { robot, drawn: "", _parts: null, _frame: null, _next: null });
        if (robot.keeps_view) this.camera.moved = true;
        else Object.assign(this, { ground: null, _framed: 0 });
        Object.assign(this, { awaiting: true, base: [] }); // its shapes
        this.stage.recast();
    }

    command(bytes) {
        this._shapes.command(bytes);
    }

    /** Take the robot's shapes; returns what was changed about them, in sentences. */
    setShapes(message) {
        if (message.generation !== this.robot?.generation) return [];
        this.awaiting = false;
        if (!message.parts.length) return [];
        this._parts = this._shapes.parts(message);
        const notes = lighten(this._parts);
        for (const instance of this.instances) instance.setRobot(this.robot, this._parts, this.stage.fine);
        this.look.apply();
        this.stage.recast();
        this.ground = null;
        this.drawn = "";
        if (this._frame && this._fits(this._frame)) this._draw(this._frame);
        if (!this.camera.moved) this.frameAll(this._framed > 0);
        return notes;
    }

    /** Whether all robots stand in one place. */
    get overlaid() {
        return this.state?.view > 1 && Boolean(this.state.looks?.includes("overlay"));
    }

    /** The outermost points that robots have visited, in an instance's own world. */
    get visited() {
        return this._sight.visited;
    }

    setState(state) {
        const before = this.state;
        this.state = state;
        this._selected = Math.min(this._selected, Math.max(0, state.balls.length - 1));
        this.camera.together = this.overlaid;
        this._showBalls();
        this.look.setState(state);
        this.instances.forEach((instance, i) => instance.robot.redden(touched(state, i)));
        const asked = ({ balls, motion, curve, view, looks, obstacles }) => {
            const placed = ["overlay", "ellipsoid"].map((look) => looks?.includes(look)); // it makes captions taller
            return [motion, curve, view, placed, balls.map((ball) => ball.mode + ball.frame), obstacles?.length].join();
        };
        if (before && this._framed && asked(before) !== asked(state)) {
            this._sight.ask();
            this._sight.forget();
        }
        // A stopped session sends no second frame, so the latest one must do, unless it is older than the change.
        this._next = null;
        if (this._latest) this.setFrame(this._latest);
        if (!this._played) this._captions.tell(this.instances.length, state);
        this.stage.touch();
    }

    _showBalls() {
        if (!this.state || !this.robot) return;
        for (const instance of this.instances) {
            instance.setState(this.state, this.ballRadius, this._selected, this._near);
        }
        this.stage.touch();
    }

    /** Take the newest frame; the next picture shows it. */
    setFrame(buffer) {
        const frame = new Frame(buffer);
        this._latest = buffer;
        if (this._fits(frame)) this._next = frame;
        return frame;
    }

    /** Whether a frame shows the current robot and balls. */
    _fits(frame) {
        return frame.generation === this.robot?.generation && frame.balls === this.state?.balls.length;
    }

    _tick(now) {
        if (this._next) {
            const frame = this._next;
            this._next = null;
            const fades = frame.step !== this._frame?.step && this.instances.some((instance) => instance.fading);
            const moves = fades || !frame.looksLike(this._frame);
            this._frame = frame;
            if (moves || frame.instances !== this.instances.length) this._draw(frame);
        }
        if (this._frame && this._played) this._captions.say(now, this._frame, this.state);
        else if (this._frame) this._captions.tell(this._frame.instances, this.state);
        // Between a change and the first frame that shows it, the camera stays.
        const { _frame: frame, state } = this;
        if (frame && frame.instances === state.view && frame.balls === state.balls.length) this._sight.follow(now);
    }

    _draw(frame) {
        while (this.instances.length > frame.instances) this.instances.pop().dispose();
        while (this.instances.length < frame.instances) this._addInstance();
        this.balls.take(frame);
        for (const instance of this.instances) instance.update(frame, this.balls.places);
        if (this.ground === null) this._findGround();
        if (this._framed !== frame.instances) {
            this._framed = frame.instances;
            this.frameAll();
        }
        this.stage.touch();
        if (!this.awaiting) this.onComplete?.();
    }

    /** Put the ground at the lowest point of the robot's first pose. */
    _findGround() {
        const corners = this.instances[0].robot.corners();
        this.ground = Math.min(...corners.map((corner) => corner.z));
        const standing = new Extent();
        standing.add(corners.filter((corner) => corner.z < this.ground + BASE * this.robot.size));
        this.base = standing.points;
        this._moveInstances();
    }

    _addInstance() {
        const instance = new Instance(this.stage.scene, this.instances.length, this._theme);
        instance.setRobot(this.robot, this._parts, this.stage.fine);
        this.instances.push(instance);
        this._showBalls();
        this.look.apply();
        this._moveInstances();
    }

    _moveInstances() {
        this.instances.forEach((instance, i) => instance.group.position.copy(this.offset(i)));
        this.stage.recast();
    }

    /** Keep more in the picture: points (Vector3s) in an instance's own world. */
    showAlso(points) {
        this.also = points;
        if (points.length && !this.camera.moved) this._sight.ask();
        this.stage.touch();
    }

    /** The position of instance `i`: a Vector3. */
    offset(i) {
        return this.camera.offsets[i] ?? new THREE.Vector3();
    }

    /** Look at everything, smoothly or at once. */
    frameAll(smoothly = true, preset = this.camera.preset) {
        if (this.instances.length) this._sight.all(smoothly, preset);
    }

    /** The size {w, h} of the largest caption, and the height of the buttons at the upper edge [px]. */
    get taken() {
        return [this._captions.measure(), this._captions.below];
    }

    /** The robot's shapes, as `Shapes.parts` returns them; null before they arrive. */
    get parts() {
        return this._parts;
    }

    get ballRadius() {
        return BALL * this.robot.size;
    }

    /** Whether something is being dragged; the camera stays then, even if it was on its way. */
    get busy() {
        return this._busy;
    }

    hold() {
        this._busy = true;
        this._sight.wait();
    }

    release() {
        this._busy = false;
    }

    /** Whether the camera has come to rest. */
    get still() {
        return Boolean(this._framed) && !this._sight.pending && !this.camera.gliding;
    }

    _afterDrawing() {
        if (this.instances.length && this._frame && !this.drawn) this.drawn = this._parts ? "shapes" : "skeleton";
        for (const part of [this._captions, this.look]) part.place();
        this._pointers.place(this._captions.below);
    }

    _paint() {
        for (const instance of this.instances) instance.paint();
        this.look.apply();
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
        this.balls.hold(k, position);
        if (this._frame) this._draw(this._frame);
    }

    letGoOfBall(k) {
        this.release();
        this.balls.letGo(k);
    }

    /** Extend the trails by a frame that is not shown itself. */
    addToTrails(buffer) {
        const frame = new Frame(buffer);
        for (const instance of this.instances) instance.addToTrails(frame);
    }

    /** Look from the beginning at all that these frames show, so that the camera need not follow. */
    foresee(buffers) {
        for (const frame of buffers.map((buffer) => new Frame(buffer)).filter((one) => this._fits(one))) {
            this._draw(frame);
            this._sight.remember();
        }
        this.clearTrails();
        this.frameAll(false);
    }

    clearTrails() {
        for (const instance of this.instances) instance.clearTrails();
    }

    /** The position of a ball's copy in the scene, z up. */
    ballInWorld(k, instance) {
        return this.balls.places[k].position.clone().add(this.offset(instance));
    }

    /** The size of a pixel at what the camera looks at [m]. */
    get pixel() {
        const { camera, controls } = this.stage.viewer;
        const distance = camera.position.distanceTo(controls.target);
        return (2 * distance * Math.tan((camera.fov * Math.PI) / 360)) / this.stage.height;
    }

    /** Every visible copy of every ball, as `ballsOnScreen` finds them. */
    ballsOnScreen() {
        return ballsOnScreen(this);
    }
}

/** The names of what touches in instance `i`. */
function touched(state, i) {
    return new Set((state.instances[i]?.touching ?? []).flat());
}
