/** One turn of a sweep in the scene: the circle on which the joint can move the effector, the arc, and the chain. */

import { Ribbon } from "pinik/ribbon.js";
import { THREE } from "pinik/three.js";

const CIRCLE = 97; // points
const LONGEST_CHAIN = 60;

export class TurnMarks {
    constructor(theme) {
        this.group = new THREE.Group();
        this.group.name = "turn marks";
        this._theme = theme;
        this._ribbons = {
            circle: new Ribbon({ capacity: CIRCLE, width: 2.4, opacity: 0.8 }),
            arc: new Ribbon({ capacity: CIRCLE, width: 6, opacity: 0.95 }),
            axis: new Ribbon({ capacity: 2, width: 2.4, opacity: 0.9 }),
            chain: new Ribbon({ capacity: LONGEST_CHAIN, width: 5, opacity: 0.75 }),
        };
        for (const { mesh } of Object.values(this._ribbons)) {
            mesh.material.depthTest = false; // visible through the robot
            mesh.renderOrder = 5;
            this.group.add(mesh);
        }
        theme.addEventListener("change", () => this.paint());
        this.paint();
    }

    paint(own = this._own ?? "accent") {
        this._own = own;
        const { circle, arc, axis, chain } = this._ribbons;
        circle.color = axis.color = this._theme.color("soft-ink");
        arc.color = this._theme.color("ball");
        chain.color = this._theme.color(own);
    }

    /** @param turn one of the message's turns @param part how much of it has been made, from 0 to 1 */
    show(turn, part) {
        const origin = new THREE.Vector3(...turn.origin);
        const axis = new THREE.Vector3(...turn.axis);
        const after = new THREE.Vector3(...turn.after);
        const foot = origin.clone().addScaledVector(axis, after.clone().sub(origin).dot(axis));
        const radius = after.distanceTo(foot);
        const moved = (point, back) => {
            const at = new THREE.Vector3(...point);
            if (turn.slides) return at.addScaledVector(axis, -back * turn.amount);
            return at.sub(origin).applyAxisAngle(axis, -back * turn.amount).add(origin);
        };
        const along = (from, to, count) =>
            Array.from({ length: count }, (_, k) => moved(turn.after, 1 - (from + (k / (count - 1)) * (to - from))));
        const whole = turn.slides ? 1 : Math.abs((2 * Math.PI) / (turn.amount || 1e-9));
        set(this._ribbons.circle, turn.slides || !turn.amount ? [] : along(0, whole, CIRCLE));
        set(this._ribbons.arc, along(0, Math.max(part, 1e-3), 48));
        const half = axis.clone().multiplyScalar(0.35 * Math.max(radius, 0.1));
        set(this._ribbons.axis, [foot.clone().sub(half), foot.clone().add(half)]);
        const chain = turn.chain.slice(0, LONGEST_CHAIN);
        set(this._ribbons.chain, chain.map((point, k) => (k >= turn.moved ? moved(point, 1 - part) : new THREE.Vector3(...point))));
    }

    hide() {
        for (const ribbon of Object.values(this._ribbons)) ribbon.set([], 0);
    }
}

function set(ribbon, points) {
    ribbon.set(points.flatMap(({ x, y, z }) => [x, y, z]), points.length);
}
