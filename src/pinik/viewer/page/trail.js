/** The way that an effector came lately: like a comet's tail, gone when it stands still. */

import { Ribbon } from "pinik/ribbon.js";

const POINTS = 90; // frames that are remembered: a second and a half

export class Trail {
    constructor() {
        this._ribbon = new Ribbon({ capacity: POINTS, width: 7, opacity: 0.85, taper: 1 });
        this._points = new Float32Array(3 * POINTS);
        this._count = 0;
        this._still = 0;
    }

    get mesh() {
        return this._ribbon.mesh;
    }

    set color(css) {
        this._ribbon.color = css;
    }

    /** Whether it still changes while its effector does not. */
    get fading() {
        return this._count > 0 && this._still < POINTS;
    }

    add(x, y, z) {
        const [last, points] = [3 * (this._count - 1), this._points];
        const same = this._count > 0 && points[last] === x && points[last + 1] === y && points[last + 2] === z;
        this._still = same ? this._still + 1 : 0;
        if (this._still >= POINTS) {
            this._ribbon.set(points, 0);
            return;
        }
        if (this._count === POINTS) points.copyWithin(0, 3);
        else this._count += 1;
        points.set([x, y, z], 3 * (this._count - 1));
        this._ribbon.set(points, this._count);
    }

    clear() {
        this._count = 0;
        this._still = 0;
        this._ribbon.set(this._points, 0);
    }

    dispose() {
        this._ribbon.dispose();
    }
}
