/** The marks of joints at their limits: amber rings. */

import { THREE } from "pinik/three.js";

const SIZE = 0.07; // as a fraction of the robot's size

export class LimitMarks {
    /** @param robot the `robot` message */
    constructor(robot) {
        this.group = new THREE.Group();
        this._size = SIZE * robot.size;
        this._rings = new Map();
    }

    /**
     * @param sides for each joint, as in a frame
     * @param asked indices of the joints whose limits matter
     * @param joints Object3Ds at the joints
     */
    update(sides, asked, joints) {
        joints.forEach((joint, j) => {
            const marked = Math.abs(sides[j]) === 1 && asked.has(j);
            const ring = this._rings.get(j) ?? (marked ? this._addRing(j) : null);
            if (!ring) return;
            ring.visible = marked;
            ring.position.copy(joint.position);
        });
    }

    _addRing(j) {
        const ring = new THREE.Sprite(ringMaterial());
        ring.scale.setScalar(this._size);
        ring.renderOrder = 5;
        this._rings.set(j, ring);
        this.group.add(ring);
        return ring;
    }
}

let shared = null;

function ringMaterial() {
    if (shared) return shared;
    const canvas = Object.assign(document.createElement("canvas"), { width: 128, height: 128 });
    const pen = canvas.getContext("2d");
    for (const [width, color] of [
        [15, "rgba(30, 20, 0, 0.5)"],
        [9, "#ffb000"],
    ]) {
        pen.lineWidth = width;
        pen.strokeStyle = color;
        pen.beginPath();
        pen.arc(64, 64, 50, 0, 2 * Math.PI);
        pen.stroke();
    }
    const map = new THREE.CanvasTexture(canvas);
    map.encoding = THREE.sRGBEncoding;
    shared = new THREE.SpriteMaterial({ map, depthTest: false, depthWrite: false });
    return shared;
}

/** The joints that move a ball's frame: their limits may be why it misses. All joints if a frame is not a link. */
export function askedJoints(robot, { balls, limits }) {
    const asked = new Set();
    for (const { frame, mode } of limits ? balls : []) {
        if (mode === "off") continue;
        const link = robot.links.find(({ name }) => name === frame);
        if (!link) return new Set(robot.joints.keys());
        for (let j = link.joint; j > 0; j = robot.joints[j].parent) asked.add(j);
    }
    return asked;
}
