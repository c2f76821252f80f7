/** Everything in the 3-D picture, controlled by the session's messages. The live page and saved animations share it. */

import { Balls } from "pinik/balls.js";
import { Camera } from "pinik/camera.js";
import { Captions } from "pinik/captions.js";
import { Cast } from "pinik/cast.js";
import { Frame } from "pinik/frame.js";
import { Look } from "pinik/look.js";
import { ballsOnScreen } from "pinik/on_screen.js";
import { Pointers } from "pinik/pointers.js";
import { lighten, Shapes } from "pinik/shapes.js";
import { Sight } from "pinik/sight.js";
import { Stage } from "pinik/stage.js";

export class Show {
    /** @param options played: whether the frames are a recording, whose results no state tells */
    constructor({ canvas, labels }, theme, { played = false } = {}) {
        this._played = played;
        this.stage = new Stage(canvas, theme);
        this.camera = new Camera(this.stage);
        this.cast = new Cast(this.stage, this.camera, theme);
        this.balls = new Balls();
        this._shapes = new Shapes(this.stage.viewer, "shapes");
        this.also = [];
        this._captions = new Captions(labels, this);
        this._pointers = new Pointers(labels, this);
        this.look = new Look(labels, this);
        this.selected = 0;
        [this._near, this._busy] = [null, false];
        this._sight = new Sight(this);
        this.drawn = "";
        theme.addEventListener("change", () => this._paint());
        this.stage.onTick((now) => this._tick(now));
        this.stage.onResize = () => !this.camera.moved && this.frameAll(false);
        this.stage.onDrawn = () => this._afterDrawing();
    }

    setHello(hello) {
        this._captions.setHello(hello);
    }

    setRobot(robot) {
        this.cast.setRobot(robot);
        this._shapes.clear();
        this.look.forget();
        this.balls.forget();
        this._sight.forget();
        Object.assign(this, { drawn: "", _frame: null, _next: null, awaiting: true }); // its shapes
        if (robot.keeps_view) this.camera.moved = true;
        else this._framed = 0;
    }

    command(bytes) {
        this._shapes.command(bytes);
    }

    /** Take the robot's shapes; returns what was changed about them, in sentences. */
    setShapes(message) {
        if (message.generation !== this.robot?.generation) return [];
        this.awaiting = false;
        if (!message.parts.length) return [];
        const parts = this._shapes.parts(message);
        const notes = lighten(parts);
        this.cast.setParts(parts);
        this._showBalls();
        this.look.apply();
        this.drawn = "";
        if (this._frame && this._fits(this._frame)) this._draw(this._frame);
        if (!this.camera.moved) this.frameAll(this._framed > 0);
        return notes;
    }

    get robot() {
        return this.cast.robot;
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
        this.selected = Math.min(this.selected, Math.max(0, state.balls.length - 1));
        this.camera.together = this.overlaid;
        this._showBalls();
        this.look.setState(state);
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
        if (!this._played) this._captions.tell(this.cast.instances.length, state);
        this.stage.touch();
    }

    _showBalls() {
        if (!this.state || !this.robot) return;
        this.cast.setState(this.state, this.selected, this._near);
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
            const fades = frame.step !== this._frame?.step && this.cast.fades;
            const moves = fades || !frame.looksLike(this._frame);
            this._frame = frame;
            if (moves || frame.instances !== this.cast.instances.length) this._draw(frame);
        }
        if (this._frame && this._played) this._captions.say(now, this._frame, this.state);
        else if (this._frame) this._captions.tell(this._frame.instances, this.state);
        // Between a change and the first frame that shows it, the camera stays.
        const { _frame: frame, state } = this;
        if (frame && frame.instances === state.view && frame.balls === state.balls.length) this._sight.follow(now);
    }

    _draw(frame) {
        if (this.cast.setCount(frame.instances)) {
            this._showBalls();
            this.look.apply();
        }
        this.balls.take(frame);
        this.cast.update(frame, this.balls.places);
        if (this._framed !== frame.instances) {
            this._framed = frame.instances;
            this.frameAll();
        }
        this.stage.touch();
        if (!this.awaiting) this.onComplete?.();
    }

    /** Keep more in the picture: points (Vector3s) in an instance's own world. */
    showAlso(points) {
        this.also = points;
        if (points.length && !this.camera.moved) this._sight.ask();
        this.stage.touch();
    }

    /** Look at everything, smoothly or at once. */
    frameAll(smoothly = true, preset = this.camera.preset) {
        if (this.cast.instances.length) this._sight.all(smoothly, preset);
    }

    /** The size {w, h} of the largest caption, and the height of the buttons at the upper edge [px]. */
    get taken() {
        return [this._captions.measure(), this._captions.below];
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
        if (this._frame && !this.drawn) this.drawn = this.cast.parts ? "shapes" : "skeleton";
        for (const part of [this._captions, this.look]) part.place();
        this._pointers.place(this._captions.below);
    }

    _paint() {
        this.cast.paint();
        this.look.apply();
        this.stage.touch();
    }

    select(k) {
        this.selected = k;
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
        this.cast.addToTrails(new Frame(buffer));
    }

    /** Look from the beginning at all that these frames show, so that the camera need not follow. */
    foresee(buffers) {
        for (const frame of buffers.map((buffer) => new Frame(buffer)).filter((one) => this._fits(one))) {
            this._draw(frame);
            this._sight.remember();
        }
        this.cast.clearTrails();
        this.frameAll(false);
    }

    /** The position of a ball's copy in the scene, z up. */
    ballInWorld(k, instance) {
        return this.balls.places[k].position.clone().add(this.cast.offset(instance));
    }

    /** Every visible copy of every ball, as `ballsOnScreen` finds them. */
    ballsOnScreen() {
        return ballsOnScreen(this);
    }
}
