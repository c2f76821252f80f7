/** A robot whose shapes are missing or not there yet: spheres at its joints, and rods between them. */

import { THREE } from "pinik/three.js";

const UP = new THREE.Vector3(0, 1, 0);
const SPHERE = new THREE.SphereGeometry(1, 24, 16);
const ROD = new THREE.CylinderGeometry(0.7, 1, 1, 16);

export class Skeleton {
    /** @param robot the `robot` message */
    constructor(robot, color) {
        this.group = new THREE.Group();
        this._radius = 0.018 * robot.size;
        this._bone = new THREE.MeshLambertMaterial({ color: 0x8d98a5 });
        this._joint = new THREE.MeshLambertMaterial({ color });
        this._spheres = robot.joints.map((_, j) => this._add(SPHERE, j ? this._joint : this._bone));
        // A link that begins away from its joint, such as a tool tip, gets a rod of its own.
        const ends = robot.links.map((link) => ({ joint: link.joint, at: new THREE.Vector3(...link.placement) }));
        this._rods = [
            ...robot.joints.map((joint, j) => ({ from: joint.parent, to: j })).slice(1),
            ...ends.filter(({ at }) => at.length() > 0.01 * robot.size).map(({ joint, at }) => ({ from: joint, at })),
        ].map((rod) => ({ ...rod, mesh: this._add(ROD, this._bone) }));
    }

    /** How far a skeleton, with a ball at its end, reaches below its joints [m]. */
    get depth() {
        return 1.5 * this._radius;
    }

    _add(geometry, material) {
        const mesh = new THREE.Mesh(geometry, material);
        mesh.castShadow = true;
        this.group.add(mesh);
        return mesh;
    }

    /** @param joints Object3Ds at the joints */
    update(joints) {
        this._spheres.forEach((sphere, j) => {
            sphere.position.copy(joints[j].position);
            sphere.scale.setScalar(this._radius);
        });
        for (const { from, to, at, mesh } of this._rods) {
            const a = joints[from].position;
            const b = at ? at.clone().applyQuaternion(joints[from].quaternion).add(a) : joints[to].position;
            const along = b.clone().sub(a);
            const length = along.length();
            mesh.visible = length > 1e-4;
            mesh.position.copy(a).addScaledVector(along, 0.5);
            mesh.scale.set(0.55 * this._radius, length, 0.55 * this._radius);
            if (mesh.visible) mesh.quaternion.setFromUnitVectors(UP, along.divideScalar(length));
        }
    }

    fade(opacity) {
        for (const material of [this._bone, this._joint]) Object.assign(material, { transparent: true, opacity });
    }

    dispose() {
        this._bone.dispose();
        this._joint.dispose();
    }
}
