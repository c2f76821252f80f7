/** The manipulability ellipsoid at each effector of one robot. */

import { jacobian, singular } from "pinik/manipulability.js";
import { THREE } from "pinik/three.js";
import { significant } from "pinik/words.js";

const SECONDS = 0.12; // the ellipsoid is what the effector covers in this time, at joint speeds of length one
const THINNEST = 0.003; // as a fraction of the robot's size, so that a flat one can be seen
const SPHERE = new THREE.SphereGeometry(1, 32, 20);

export class Ellipsoids {
    /** @param color CSS colour of the instance */
    constructor(robot, color) {
        this.group = new THREE.Group();
        this.note = "";
        this._robot = robot;
        this._material = new THREE.MeshLambertMaterial({
            color: new THREE.Color(color).convertSRGBToLinear(),
            transparent: true,
            opacity: 0.3,
            depthWrite: false,
        });
        this._meshes = [];
    }

    /** @param balls those of the state; `points` are the effectors' places, three numbers each */
    update(joints, balls, points) {
        while (this._meshes.length < balls.length) this._add();
        while (this._meshes.length > balls.length) this.group.remove(this._meshes.pop());
        this.note = "";
        balls.forEach(({ frame, mode }, k) => {
            const mesh = this._meshes[k];
            const link = this._robot.links.find(({ name }) => name === frame);
            mesh.visible = mode !== "off" && Boolean(link);
            if (!mesh.visible) return;
            mesh.position.fromArray(points, 3 * k);
            const { values, ways } = singular(jacobian(this._robot, joints, link.joint, mesh.position));
            const [a, b] = ways;
            mesh.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(a, b, a.clone().cross(b)));
            const least = THINNEST * this._robot.size;
            mesh.scale.set(...values.map((value) => Math.max(SECONDS * value, least)));
            this.note ||= `σ ${values.map((value) => (value < 5e-4 ? "0" : significant(value))).join(", ")}`;
        });
    }

    _add() {
        const mesh = new THREE.Mesh(SPHERE, this._material);
        mesh.renderOrder = 3;
        this._meshes.push(mesh);
        this.group.add(mesh);
    }

    dispose() {
        this.group.parent?.remove(this.group);
        this._material.dispose();
    }
}
