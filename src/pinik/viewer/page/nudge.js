/** Moving the selected ball by keys: up and down, and along the horizontal world axis nearest to the arrow. */

const STEP = 0.015; // as a fraction of the robot's size
const FINE = 0.1;
const CATCH_UP = 600; // [ms] after the last key during which the session's position is ignored

export class Nudge {
    /** @param show the scene; `send(k, position)` tells the session */
    constructor(show, send) {
        this._show = show;
        this._send = send;
        this._at = null;
    }

    /** @param key "ArrowLeft", …, "PageUp", "PageDown" */
    press(key, k, fine) {
        const place = this._show.balls.places[k];
        if (!place) return;
        const { right, away } = this._show.camera.levelAxes;
        const [axis, sign] = {
            ArrowRight: [right, 1],
            ArrowLeft: [right, -1],
            ArrowUp: [away, 1],
            ArrowDown: [away, -1],
            PageUp: [[0, 0, 1], 1],
            PageDown: [[0, 0, 1], -1],
        }[key];
        const step = STEP * this._show.robot.size * (fine ? FINE : 1) * sign;
        const now = performance.now();
        // Keys come faster than the session answers, so continue from where the last one put the ball.
        const follows = this._at && this._at.k === k && now - this._at.time < CATCH_UP;
        const from = follows ? this._at.position : place.position.toArray();
        const position = from.map((value, i) => value + step * axis[i]);
        this._at = { k, position, time: now };
        this._send(k, position);
    }
}
