/** The balls' positions: those of the session, or those of a drag until the session follows. */

import { THREE } from "pinik/three.js";

const HOLD = 250; // [ms] after a drag during which the session catches up

export class Balls {
    constructor() {
        this._places = [];
        this._held = new Map();
    }

    /** Take the positions from a frame, except those of balls being dragged. */
    take(frame) {
        while (this._places.length < frame.balls) {
            this._places.push({ position: new THREE.Vector3(), quaternion: new THREE.Quaternion() });
        }
        this._places.length = frame.balls;
        this._places.forEach(({ position, quaternion }, k) => {
            const numbers = frame.ball(k);
            if (this._isHeld(k)) return;
            quaternion.fromArray(numbers, 3);
            position.fromArray(numbers);
        });
    }

    get places() {
        return this._places;
    }

    _isHeld(k) {
        const until = this._held.get(k);
        if (until === undefined) return false;
        if (performance.now() < until) return true;
        this._held.delete(k);
        return false;
    }

    /** Put a ball somewhere; frames do not move it until it is released. */
    hold(k, position) {
        this._held.set(k, Infinity);
        this._places[k]?.position.copy(position);
    }

    /** Turn a ball; frames do not move it until it is released. */
    turn(k, quaternion) {
        this._held.set(k, Infinity);
        this._places[k]?.quaternion.copy(quaternion);
    }

    letGo(k) {
        if (this._held.has(k)) this._held.set(k, performance.now() + HOLD);
    }

    forget() {
        this._held.clear();
    }
}
