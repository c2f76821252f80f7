/** One instance of the robot in the scene: its shapes or its skeleton. */

import { LimitMarks } from "pinik/limit_marks.js";
import { quickMaterial } from "pinik/quick_material.js";
import { Skeleton } from "pinik/skeleton.js";
import { THREE } from "pinik/three.js";

const RED = new THREE.Color(0xe02f44).convertSRGBToLinear();

export class Robot {
    /**
     * @param robot the `robot` message
     * @param parts the result of `Shapes.parts`, or null before the shapes arrive
     * @param color CSS colour of the instance
     */
    constructor(robot, parts, color) {
        this.group = new THREE.Group();
        this._parts = [];
        this._joints = robot.joints.map(() => new THREE.Group());
        this._links = robot.links.map((link) => {
            const group = new THREE.Group();
            place(group, link.placement, 0);
            this._joints[link.joint].add(group);
            return group;
        });
        const materials = robot.links.map(() => []);
        for (const part of parts ?? []) {
            const fine = part.material.clone();
            const coarse = quickMaterial(fine);
            const mesh = new THREE.Mesh(part.geometry, fine);
            mesh.castShadow = true;
            this._links[part.link].add(mesh);
            this._parts.push({ mesh, fine, coarse, own: fine.color.clone(), link: robot.links[part.link].name });
            materials[part.link].push(fine, coarse);
        }
        this._marks = new LimitMarks(robot, carriedBy(robot, materials));
        this.group.add(...this._joints, this._marks.group);
        this._skeleton = parts?.length ? null : new Skeleton(robot, new THREE.Color(color).convertSRGBToLinear());
        if (this._skeleton) this.group.add(this._skeleton.group);
    }

    /** Take the pose of instance `i` of a frame; `asked` are the joints whose limits matter. */
    update(frame, i, asked) {
        const placements = frame.placements(i);
        this._joints.forEach((joint, j) => place(joint, placements, 7 * j));
        this._skeleton?.update(this._joints);
        this._marks.update(frame.sides(i), asked, this._joints);
    }

    /** Draw in detail, with shadows on itself, or quickly. */
    refine(isFine) {
        for (const { mesh, fine, coarse } of this._parts) {
            mesh.material = isFine ? fine : coarse;
            mesh.receiveShadow = isFine;
        }
    }

    /** Draw the robot as a ghost. */
    fade(opacity) {
        for (const { mesh, fine } of this._parts) {
            Object.assign(fine, { transparent: true, opacity, depthWrite: false });
            mesh.material = fine;
            mesh.castShadow = false;
        }
        this._skeleton?.fade(opacity);
    }

    /** Paint the links with these names red, and only them. The quick materials share the colours. */
    redden(names) {
        for (const { fine, own, link } of this._parts) fine.color.copy(names.has(link) ? RED : own);
    }

    /** The corners of the boxes around the robot's parts, in its own world: Vector3s. */
    corners() {
        const inverse = new THREE.Matrix4();
        this.group.updateWorldMatrix(true, true);
        inverse.copy(this.group.matrixWorld).invert();
        const points = this._joints.slice(1).map((joint) => joint.position.clone());
        for (const link of this._links) {
            for (const mesh of link.children) {
                if (!mesh.geometry.boundingBox) mesh.geometry.computeBoundingBox();
                const { min, max } = mesh.geometry.boundingBox;
                const toRobot = inverse.clone().multiply(mesh.matrixWorld);
                for (let k = 0; k < 8; k++) {
                    const corner = new THREE.Vector3(
                        k & 1 ? max.x : min.x,
                        k & 2 ? max.y : min.y,
                        k & 4 ? max.z : min.z,
                    );
                    points.push(corner.applyMatrix4(toRobot));
                }
            }
        }
        return points.length ? points : [new THREE.Vector3()]; // a robot without joints and shapes
    }

    dispose() {
        this.group.parent?.remove(this.group);
        this._skeleton?.dispose();
        for (const { fine, coarse } of this._parts) {
            fine.dispose();
            coarse.dispose();
        }
    }
}

function place(object, numbers, k) {
    object.position.set(numbers[k], numbers[k + 1], numbers[k + 2]);
    object.quaternion.set(numbers[k + 3], numbers[k + 4], numbers[k + 5], numbers[k + 6]);
}

/** For each joint, the materials of its links or, if they have no shapes, of the joints that it carries. */
function carriedBy(robot, materials) {
    const own = robot.joints.map((_, j) => robot.links.flatMap((link, k) => (link.joint === j ? materials[k] : [])));
    const carried = [...own];
    for (let j = robot.joints.length - 1; j > 0; j--) {
        const children = robot.joints.map((joint, k) => (k > j && joint.parent === j ? k : null)).filter(Boolean);
        if (!carried[j].length) carried[j] = children.flatMap((k) => carried[k]);
    }
    return carried;
}
