/** One of the robots side by side, with its own copies of the balls and curves and its effectors' trails. */

import { Ball } from "pinik/ball.js";
import { Decor } from "pinik/decor.js";
import { askedJoints } from "pinik/limit_marks.js";
import { Ribbon } from "pinik/ribbon.js";
import { Robot } from "pinik/robot.js";
import { THREE } from "pinik/three.js";
import { Trail } from "pinik/trail.js";

const CURVE_POINTS = 129;

export class Instance {
    constructor(scene, index, theme) {
        this.group = new THREE.Group();
        this._targets = new THREE.Group(); // balls and curves, which robots in one place share
        this.group.add(this._targets);
        this._index = index;
        this._theme = theme;
        this._sets = [];
        this._asked = new Set();
        this.robot = null;
        scene.add(this.group);
    }

    /** Show another robot, or the same one once its shapes have arrived. */
    setRobot(robot, parts, fine) {
        this._decor?.dispose();
        this.robot?.dispose();
        this.robot = new Robot(robot, parts, this._theme.color(`instance-${this._index}`));
        this.robot.refine(fine);
        this._message = robot;
        this.group.add(this.robot.group);
        this._decor = new Decor(robot, this.robot, this._theme.color(`instance-${this._index}`));
    }

    /** Show the looks that are on; `overlaid` if all instances stand in one place. */
    setLook(looks, extras, overlaid) {
        this.robot.look(
            overlaid ? this._theme.color(`instance-${this._index}`) : null,
            looks.includes("transparent") || looks.includes("collisions"),
        );
        this._decor.set(looks, extras);
        // A stopped session sends no frame that would show it.
        if (this._points?.length === 3 * this._balls?.length) this._decor.update(this._balls, this._points);
        this._targets.visible = !overlaid || this._index === 0;
    }

    /** What its caption says besides the result. */
    get note() {
        return this._decor?.note ?? "";
    }

    /** Show the balls of a state. */
    setState(state, radius, selected, near) {
        const { balls } = state;
        this._balls = balls;
        this._asked = askedJoints(this._message, state);
        if (this._sets.length !== balls.length || this._radius !== radius) {
            this._clearBalls();
            this._radius = radius;
            this._sets = balls.map(() => this._makeSet(radius, balls.length));
            this.paint();
        }
        balls.forEach((ball, k) => {
            const set = this._sets[k];
            set.mode = ball.mode;
            set.free = ball.free;
            set.tolerance = Math.max(...[ball.tolerance?.[0] ?? state.tolerance.position].flat());
            set.ball.show(ball, k === selected, k === near);
            this._layCurve(set, ball.curve);
        });
    }

    _makeSet(radius, count) {
        const set = {
            ball: new Ball(radius),
            curve: new Ribbon({ capacity: CURVE_POINTS, width: 2.6, opacity: 0.75 }),
            gap: new Ribbon({ capacity: 2, width: 2.2, opacity: 0.8 }),
            trail: new Trail(count),
            laid: "",
        };
        this._targets.add(set.ball.group, set.curve.mesh);
        this.group.add(set.gap.mesh, set.trail.mesh);
        return set;
    }

    _layCurve(set, curve) {
        const laid = [curve.length, ...(curve[0] ?? []), ...(curve[1] ?? []), ...(curve[40] ?? [])].join();
        if (laid === set.laid) return;
        set.laid = laid;
        const closed = curve.length ? [...curve, curve[0]].slice(0, CURVE_POINTS) : [];
        set.curve.set(closed.flat(), closed.length);
    }

    paint() {
        const own = this._theme.color(`instance-${this._index}`);
        for (const { ball, curve, gap, trail } of this._sets) {
            ball.paint(this._theme);
            curve.color = this._theme.color("curve");
            gap.color = own;
            trail.color = own;
        }
    }

    /** @param places {position: Vector3, quaternion: Quaternion} of each ball */
    update(frame, places) {
        this.robot.update(frame, this._index, this._asked);
        const points = (this._points = frame.points(this._index));
        this._decor.update(this._balls, points);
        this._sets.forEach(({ ball, gap, trail, mode, free, tolerance }, k) => {
            const { position, quaternion } = places[k];
            const [x, y, z] = points.subarray(3 * k, 3 * k + 3);
            const asked = nearest(position, { x, y, z }, free);
            ball.place(position.x, position.y, position.z, quaternion);
            if (mode === "off") {
                trail.clear();
                gap.set([], 0);
                return;
            }
            trail.add(frame.step, x, y, z);
            const away = Math.hypot(asked[0] - x, asked[1] - y, asked[2] - z);
            const visible = away > Math.max(1.1 * this._radius, tolerance);
            gap.set([x, y, z, ...asked], visible ? 2 : 0);
        });
    }

    /** Extend the trails by a frame without moving the robot. */
    addToTrails(frame) {
        const points = frame.points(this._index);
        this._sets.forEach(({ trail }, k) => trail.add(frame.step, ...points.subarray(3 * k, 3 * k + 3)));
    }

    get fading() {
        return this._sets.some(({ trail }) => trail.fading);
    }

    clearTrails() {
        for (const { trail } of this._sets) trail.clear();
    }

    _clearBalls() {
        for (const { ball, curve, gap, trail } of this._sets) {
            for (const part of [ball, curve, gap, trail]) part.dispose();
        }
        this._sets = [];
    }

    dispose() {
        this._clearBalls();
        this._decor?.dispose();
        this.robot?.dispose();
        this.group.parent.remove(this.group);
    }
}

/** The place nearest to a point of those that a ball with these free axes asks for: [x, y, z]. */
function nearest(ball, point, free) {
    return ["x", "y", "z"].map((axis) => (free.includes(axis) ? point : ball)[axis]);
}
