/** The recent path of an effector. Like a comet's tail, it fades while the effector stands still. */

import { Ribbon } from "pinik/ribbon.js";

const STEPS = 90; // of the session, 60 per second
const POINTS = 90;
const MANY = 2; // effectors of one robot, beyond which trails are thin, so that they do not look like limbs

export class Trail {
    /** @param count the number of trails of one robot */
    constructor(count) {
        const look = count > MANY ? { width: 2.6, opacity: 0.5 } : { width: 4.5, opacity: 0.75 };
        this._ribbon = new Ribbon({ capacity: POINTS, ...look, taper: 1 });
        this._points = [];
    }

    get mesh() {
        return this._ribbon.mesh;
    }

    set color(css) {
        this._ribbon.color = css;
    }

    /** Whether the trail changes even if the effector does not move. */
    get fading() {
        return this._points.length > 0;
    }

    add(step, x, y, z) {
        const points = this._points;
        const last = points[points.length - 1];
        if (last && last.step > step) this.clear();
        if (!last || last.x !== x || last.y !== y || last.z !== z) points.push({ step, x, y, z });
        while (points.length > POINTS || (points.length && points[0].step < step - STEPS)) points.shift();
        this._ribbon.set(
            points.flatMap((point) => [point.x, point.y, point.z]),
            points.length,
        );
    }

    clear() {
        this._points.length = 0;
        this._ribbon.set([], 0);
    }

    dispose() {
        this._ribbon.dispose();
    }
}
