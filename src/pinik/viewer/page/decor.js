/** What the "Show" menu adds to one robot: axes of its frames and joints, collision shapes, ellipsoids, and its reach. */

import { Ellipsoids } from "pinik/ellipsoid.js";
import { THREE } from "pinik/three.js";

const ROD = new THREE.CylinderGeometry(0.035, 0.035, 1, 8).translate(0, 0.5, 0);
const AXLE = new THREE.CylinderGeometry(0.05, 0.05, 2, 12);
const UP = new THREE.Vector3(0, 1, 0);
const COLORS = ["#e5484d", "#3d9a50", "#3b7ddd"].map(plain);
const [TURNS, SLIDES] = ["#f0a000", "#8a63d2"].map(plain);
const NEARER = { polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -4 }; // than a surface in the same place
const HULL = plain("#00a3a3", { transparent: true, opacity: 0.4, depthWrite: false, ...NEARER });
const WAYS = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
].map((way) => new THREE.Quaternion().setFromUnitVectors(UP, new THREE.Vector3(...way)));
const FRAME = 0.055; // the length of a frame's axes, as a fraction of the robot's size
const JOINT = 0.06; // half the length of a joint's axis, likewise

export class Decor {
    /**
     * @param message the `robot` message
     * @param robot the instance's Robot
     * @param color CSS colour of the instance
     */
    constructor(message, robot, color) {
        Object.assign(this, { _message: message, _robot: robot, _color: color });
        this._made = new Map();
    }

    /**
     * @param looks names of those that are on
     * @param extras {collisions: parts or null, reach: [{joint, geometry}]}
     */
    set(looks, extras) {
        this._show("axes", looks, true, () => this._frameAxes());
        this._show("joint_axes", looks, true, () => this._jointAxes());
        this._show("collisions", looks, extras.collisions, () => this._hulls(extras.collisions));
        this._show("reach", looks, extras.reach, () => this._clouds(extras.reach));
        if (looks.includes("ellipsoid")) {
            this._ellipsoids ??= new Ellipsoids(this._message, this._color);
            this._robot.group.add(this._ellipsoids.group);
        } else {
            this._ellipsoids?.dispose();
            this._ellipsoids = null;
        }
    }

    /** Make, or remove, the objects of one look; `source` is what they are made of. */
    _show(name, looks, source, make) {
        const wanted = looks.includes(name) ? source : null;
        const made = this._made.get(name);
        if (made?.source === wanted || (!made && !wanted)) return;
        for (const object of made?.objects ?? []) {
            object.parent?.remove(object);
            if (object.isPoints) object.material.dispose();
        }
        this._made.delete(name);
        if (wanted) this._made.set(name, { source: wanted, objects: make() });
    }

    update(balls, points) {
        this._ellipsoids?.update(this._robot.joints, balls, points);
    }

    /** The singular values at the first effector in words, or "". */
    get note() {
        return this._ellipsoids?.note ?? "";
    }

    _onJoint(joint, object) {
        this._robot.joints[joint].add(object);
        return object;
    }

    _frameAxes() {
        const length = FRAME * this._message.size;
        return this._message.links.map(({ joint, placement }) => {
            const group = new THREE.Group();
            group.position.fromArray(placement);
            group.quaternion.fromArray(placement, 3);
            WAYS.forEach((way, axis) => {
                const rod = inFront(new THREE.Mesh(ROD, COLORS[axis]));
                rod.quaternion.copy(way);
                rod.scale.setScalar(length);
                group.add(rod);
            });
            return this._onJoint(joint, group);
        });
    }

    _jointAxes() {
        const length = JOINT * this._message.size;
        return this._message.joints.flatMap(({ axis, kind }, j) => {
            if (!axis) return [];
            const rod = inFront(new THREE.Mesh(AXLE, kind === "prismatic" ? SLIDES : TURNS));
            rod.quaternion.setFromUnitVectors(UP, new THREE.Vector3(...axis));
            rod.scale.setScalar(length);
            return [this._onJoint(j, rod)];
        });
    }

    _hulls(parts) {
        return parts.map(({ link, fine }) => {
            const { joint, placement } = this._message.links[link];
            const mesh = new THREE.Mesh(fine, HULL);
            mesh.position.fromArray(placement);
            mesh.quaternion.fromArray(placement, 3);
            return this._onJoint(joint, mesh);
        });
    }

    _clouds(clouds) {
        return clouds.map(({ joint, geometry }) => {
            const material = new THREE.PointsMaterial({
                color: new THREE.Color(this._color),
                size: 2.5,
                sizeAttenuation: false,
                transparent: true,
                opacity: 0.6,
                depthWrite: false,
            });
            const points = new THREE.Points(geometry, material);
            points.frustumCulled = false;
            return this._onJoint(joint, points);
        });
    }

    dispose() {
        this.set([], {});
    }
}

function plain(color, options = {}) {
    return new THREE.MeshLambertMaterial({ color: new THREE.Color(color).convertSRGBToLinear(), ...options });
}

/** Axes lie inside of parts, so they are drawn over them. */
function inFront(mesh) {
    mesh.material.depthTest = false;
    mesh.material.transparent = true; // drawn after everything solid
    mesh.renderOrder = 4;
    return mesh;
}
