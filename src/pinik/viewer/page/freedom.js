/** What a ball with free axes asks for: any place on a line, or on a disc. */

import { THREE } from "pinik/three.js";

const REACH = 9; // half the size, in radii of the ball
const WAYS = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
const ROD = new THREE.CylinderGeometry(0.12, 0.12, 2 * REACH, 10).rotateX(Math.PI / 2); // along z
const DISC = new THREE.CircleGeometry(REACH, 64); // across z
const RIM = new THREE.RingGeometry(REACH - 0.22, REACH, 64);
const UP = new THREE.Vector3(0, 0, 1);

export class Freedom {
    constructor() {
        this.group = new THREE.Group();
        this._strong = material(0.6);
        this._faint = material(0.13);
        this._rod = new THREE.Mesh(ROD, this._strong);
        this._disc = new THREE.Group();
        this._disc.add(new THREE.Mesh(DISC, this._faint), new THREE.Mesh(RIM, this._strong));
        this.group.add(this._rod, this._disc);
    }

    /** @param free the letters of the free axes, such as "xy" */
    show(free) {
        this._rod.visible = free.length === 1;
        this._disc.visible = free.length === 2;
        const way = free.length === 1 ? free : Object.keys(WAYS).find((axis) => !free.includes(axis));
        if (way) this.group.quaternion.setFromUnitVectors(UP, new THREE.Vector3(...WAYS[way]));
    }

    paint(theme) {
        for (const own of [this._strong, this._faint]) own.color.set(theme.color("ball")).convertSRGBToLinear();
    }

    dispose() {
        this._strong.dispose();
        this._faint.dispose();
    }
}

function material(opacity) {
    return new THREE.MeshBasicMaterial({ transparent: true, opacity, depthWrite: false, side: THREE.DoubleSide });
}
