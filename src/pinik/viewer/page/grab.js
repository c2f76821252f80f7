/** Dragging a ball with the mouse or a finger, in the plane of the screen, or horizontally with Shift. */

import { snapPosition } from "pinik/snap.js";
import { THREE } from "pinik/three.js";

const REACH = { mouse: 18, pen: 22, touch: 34 }; // [px] beyond a ball's radius

export class Grab {
    /**
     * @param show the scene
     * @param handlers onGrab(k), onMove(k, [x, y, z]), onDrop(k), onHover(k or null)
     * @param over the class of the stage while the pointer is over something that can be dragged
     */
    constructor(show, handlers, over = "over-ball") {
        this._over = over;
        this._show = show;
        this._handlers = handlers;
        this._held = null;
        const { element } = show.stage;
        const capture = { capture: true };
        element.addEventListener("pointerdown", (event) => this._down(event), capture);
        element.addEventListener("pointermove", (event) => this._move(event), capture);
        // This event comes at once, whereas pointermove waits for the next picture. Not every browser has it.
        element.addEventListener("pointerrawupdate", (event) => this._held && this._move(event), capture);
        for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) {
            element.addEventListener(name, (event) => this._up(event), capture);
        }
        element.addEventListener("pointerleave", () => this._hover(null));
    }

    /** The nearest copy of a ball within reach of a pointer: {k, instance}, or null. */
    _find(event) {
        const { x, y } = this._show.stage.pointer(event);
        let found = null;
        for (const { k, instance, at, radius } of this._show.ballsOnScreen()) {
            const away = Math.hypot(at.x - x, at.y - y);
            const reach = radius + (REACH[event.pointerType] ?? REACH.mouse);
            if (!at.behind && away < reach && (!found || away < found.away)) found = { k, instance, away };
        }
        return found;
    }

    _down(event) {
        if (event.button !== 0 || this._held || event.target !== this._show.stage.canvas) return;
        const found = this._find(event);
        if (!found) return;
        event.stopPropagation();
        event.preventDefault();
        this._show.hold();
        const start = this._show.ballInWorld(found.k, found.instance);
        this._held = { ...found, pointer: event.pointerId, start, shift: null, position: start.clone() };
        this._dragged(event); // from here on, pointer and ball keep their distance
        // meshcat's camera must not turn while a ball is being dragged.
        this._show.stage.viewer.controls.enabled = false;
        this._show.stage.element.setPointerCapture(event.pointerId);
        this._show.stage.element.classList.add("grabbing");
        this._handlers.onGrab(found.k);
    }

    _move(event) {
        if (!this._held) {
            if (event.buttons === 0) this._hover(this._find(event)?.k ?? null);
            return;
        }
        if (event.pointerId !== this._held.pointer) return;
        event.stopPropagation();
        const where = `${event.clientX} ${event.clientY} ${event.shiftKey} ${event.ctrlKey || event.metaKey}`;
        if (where === this._held.where) return; // the same move, reported twice
        this._held.where = where;
        const position = this._dragged(event);
        if (!position) return;
        this._held.position = position;
        const inRobot = snapPosition(position.clone().sub(this._show.cast.offset(this._held.instance)), event);
        this._show.holdBall(this._held.k, inRobot);
        this._handlers.onMove(this._held.k, inRobot.toArray());
    }

    /** Where the pointer's ray meets the plane in which the ball is dragged; in the scene's axes, z up. */
    _dragged(event) {
        const held = this._held;
        const { stage } = this._show;
        const pointer = stage.pointer(event);
        if (held.shift !== event.shiftKey) {
            // The plane passes through the ball, and the ray keeps its distance from it, so nothing jumps.
            held.shift = event.shiftKey;
            const at = stage.project(held.position);
            held.slip = { x: at.x - pointer.x, y: at.y - pointer.y };
            const normal = event.shiftKey
                ? new THREE.Vector3(0, 0, 1)
                : stage.ray({ x: stage.width / 2, y: stage.height / 2 }).direction;
            held.plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, held.position);
        }
        const through = stage.ray({ x: pointer.x + held.slip.x, y: pointer.y + held.slip.y });
        const met = through.intersectPlane(held.plane, new THREE.Vector3());
        const limit = 4 * this._show.camera.sphere.radius;
        return met && met.distanceTo(this._show.camera.sphere.center) < limit ? met : null;
    }

    _up(event) {
        if (!this._held || event.pointerId !== this._held.pointer) return;
        const { k } = this._held;
        this._held = null;
        this._show.stage.viewer.controls.enabled = true;
        this._show.stage.element.classList.remove("grabbing");
        this._show.letGoOfBall(k);
        this._handlers.onDrop(k);
    }

    _hover(k) {
        this._show.stage.element.classList.toggle(this._over, k !== null);
        this._handlers.onHover(k);
    }
}
