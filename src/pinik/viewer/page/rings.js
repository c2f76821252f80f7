/** Three rings around the selected ball that turn the orientation that it asks for, about its own axes or the world's. */

import { ringRadius } from "pinik/on_screen.js";
import { snapAngle } from "pinik/snap.js";
import { THREE } from "pinik/three.js";

const REACH = { mouse: 9, pen: 12, touch: 20 }; // [px] from a ring
const FLAT = 0.2; // a plane seen at a smaller sine than this is edge-on
const POINTS = 48;
const TORUS = new THREE.TorusGeometry(1, 0.022, 8, 72); // around z
const AXES = [
    { color: "#e5484d", axis: new THREE.Vector3(1, 0, 0) },
    { color: "#3d9a50", axis: new THREE.Vector3(0, 1, 0) },
    { color: "#3b7ddd", axis: new THREE.Vector3(0, 0, 1) },
];

export class Rings {
    /** @param handlers selected(): the ball's number; local(): whether its own axes count; onTurn(k, rpy); onDrop(k) */
    constructor(show, handlers) {
        this._show = show;
        this._handlers = handlers;
        this._sets = [];
        this._held = null;
        this._near = null;
        const { element } = show.stage;
        const capture = { capture: true };
        element.addEventListener("pointerdown", (event) => this._down(event), capture);
        element.addEventListener("pointermove", (event) => this._move(event), capture);
        for (const name of ["pointerup", "pointercancel", "lostpointercapture"])
            element.addEventListener(name, (event) => this._up(event), capture);
        show.stage.onTick(() => this._place());
    }

    get _ball() {
        const k = this._handlers.selected();
        const ball = this._show.state?.balls[k];
        return ball?.oriented && ball.mode !== "off" && this._show.balls.places[k] ? { k, ...this._show.balls.places[k] } : null;
    }

    /** Lay the rings around every copy of the selected ball. */
    _place() {
        const { cast, stage } = this._show;
        const ball = this._ball;
        const wanted = ball ? cast.instances.length : 0;
        while (this._sets.length > wanted) this._remove(this._sets.pop());
        while (this._sets.length < wanted) this._sets.push(this._make());
        if (!ball) return;
        const turn = this._held?.frame ?? (this._handlers.local() ? ball.quaternion : new THREE.Quaternion());
        this._radius = ringRadius(this._show);
        this._sets.forEach((set, i) => {
            set.position.copy(this._show.ballInWorld(ball.k, i));
            set.quaternion.copy(turn);
            set.scale.setScalar(this._radius);
        });
    }

    _remove(set) {
        this._show.stage.scene.remove(set);
        for (const { material } of set.children) material.dispose();
    }

    _make() {
        const set = new THREE.Group();
        for (const { color, axis } of AXES) {
            const paint = new THREE.Color(color).convertSRGBToLinear();
            const material = new THREE.MeshBasicMaterial({ color: paint, transparent: true, opacity: 0.7 });
            const ring = new THREE.Mesh(TORUS, material);
            ring.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), axis);
            ring.renderOrder = 5;
            set.add(ring);
        }
        this._show.stage.scene.add(set);
        this._show.stage.touch();
        return set;
    }

    /** The ring within reach of a pointer: {axis, instance}, or null. */
    _find(event) {
        if (!this._sets.length) return null;
        const { x, y } = this._show.stage.pointer(event);
        const reach = REACH[event.pointerType] ?? REACH.mouse;
        let found = null;
        this._sets.forEach((set, instance) => {
            const middle = this._show.stage.project(set.position);
            if (Math.hypot(middle.x - x, middle.y - y) < 1.4 * (this._show.cast.ballRadius / this._show.stage.pixel)) return;
            set.children.forEach((ring, axis) => {
                for (let j = 0; j < POINTS; j++) {
                    const at = this._project(set, ring, (2 * Math.PI * j) / POINTS);
                    const away = Math.hypot(at.x - x, at.y - y);
                    if (!at.behind && away < reach && (!found || away < found.away)) found = { axis, instance, away };
                }
            });
        });
        return found;
    }

    _project(set, ring, angle) {
        const point = new THREE.Vector3(Math.cos(angle), Math.sin(angle), 0).applyQuaternion(ring.quaternion);
        point.applyQuaternion(set.quaternion).multiplyScalar(this._radius).add(set.position);
        return this._show.stage.project(point);
    }

    /** A point of a ring in the first instance, in CSS pixels of the page. */
    onScreen(axis, angle) {
        const box = this._show.stage.element.getBoundingClientRect();
        const { x, y } = this._project(this._sets[0], this._sets[0].children[axis], angle);
        return { x: box.left + x, y: box.top + y };
    }

    _down(event) {
        const { stage } = this._show;
        if (event.button !== 0 || this._held || event.target !== stage.canvas) return;
        const found = this._find(event);
        const ball = this._ball;
        if (!found || !ball) return;
        event.stopImmediatePropagation();
        event.preventDefault();
        const set = this._sets[found.instance];
        const normal = AXES[found.axis].axis.clone().applyQuaternion(set.quaternion);
        this._held = {
            k: ball.k,
            pointer: event.pointerId,
            center: set.position.clone(),
            normal,
            start: ball.quaternion.clone(),
            frame: set.quaternion.clone(),
        };
        this._held.from = this._angle(event);
        this._light(found);
        stage.viewer.controls.enabled = false;
        stage.element.setPointerCapture(event.pointerId);
        this._show.hold();
    }

    /** The angle of the pointer about the held ring's axis [rad]; along the ring on the screen where that is edge-on. */
    _angle(event) {
        const { center, normal } = this._held;
        const { stage } = this._show;
        const { x, y } = stage.pointer(event);
        const ray = stage.ray({ x, y });
        const first = new THREE.Vector3(...(Math.abs(normal.z) > 0.9 ? [1, 0, 0] : [0, 0, 1])).cross(normal).normalize();
        const second = normal.clone().cross(first);
        if (Math.abs(ray.direction.dot(normal)) > FLAT) {
            const met = ray.intersectPlane(new THREE.Plane().setFromNormalAndCoplanarPoint(normal, center), new THREE.Vector3());
            const arm = (met ?? center).clone().sub(center);
            return Math.atan2(arm.dot(second), arm.dot(first));
        }
        const along = ray.direction.clone().cross(normal).normalize();
        const tip = stage.project(center.clone().addScaledVector(along, this._radius));
        const middle = stage.project(center);
        const length = Math.hypot(tip.x - middle.x, tip.y - middle.y) || 1;
        return -((x - middle.x) * (tip.x - middle.x) + (y - middle.y) * (tip.y - middle.y)) / length ** 2;
    }

    _move(event) {
        if (!this._held) {
            if (event.buttons === 0) this._light(this._find(event));
            return;
        }
        if (event.pointerId !== this._held.pointer) return;
        event.stopImmediatePropagation();
        const { k, normal, start, from } = this._held;
        const angle = snapAngle(this._angle(event) - from, event);
        const turned = new THREE.Quaternion().setFromAxisAngle(normal, angle).multiply(start);
        this._show.balls.turn(k, turned);
        this._show.stage.touch();
        this._handlers.onTurn(k, rollPitchYaw(turned));
    }

    _light(found) {
        if (found?.axis === this._near) return;
        this._near = found?.axis;
        for (const set of this._sets)
            set.children.forEach(({ material }, axis) => {
                material.opacity = axis === this._near ? 1 : 0.7;
            });
        this._show.stage.element.classList.toggle("over-ring", this._near !== undefined);
        this._show.stage.touch();
    }

    _up(event) {
        if (!this._held || event.pointerId !== this._held.pointer) return;
        const { k } = this._held;
        this._held = null;
        this._show.stage.viewer.controls.enabled = true;
        this._show.letGoOfBall(k);
        this._handlers.onDrop(k);
    }
}

/** Fixed-axis roll, pitch and yaw [rad] of a quaternion: R = Rz(yaw) Ry(pitch) Rx(roll). */
function rollPitchYaw(quaternion) {
    const { x, y, z } = new THREE.Euler().setFromQuaternion(quaternion, "ZYX");
    return [x, y, z];
}
