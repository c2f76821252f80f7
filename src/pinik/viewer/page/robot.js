/** One instance of the robot in the scene: its shapes or its skeleton. */

import { outermost } from "pinik/extent.js";
import { LimitMarks } from "pinik/limit_marks.js";
import { quickMaterial } from "pinik/quick_material.js";
import { Skeleton } from "pinik/skeleton.js";
import { THREE } from "pinik/three.js";

const RED = new THREE.Color(0xe02f44).convertSRGBToLinear();
const GHOST = 0.5; // opacity of robots that stand in one place
const SEE_THROUGH = 0.35;

export class Robot {
    /**
     * @param robot the `robot` message
     * @param parts the result of `Shapes.parts`, or null before the shapes arrive
     * @param color CSS colour of the instance
     */
    constructor(robot, parts, color) {
        this.group = new THREE.Group();
        this._parts = [];
        this._red = new Set();
        this._ghost = null;
        this.joints = robot.joints.map(() => new THREE.Group());
        this._links = robot.links.map((link) => {
            const group = new THREE.Group();
            place(group, link.placement, 0);
            this.joints[link.joint].add(group);
            return group;
        });
        for (const part of parts ?? []) {
            const fine = part.material.clone();
            const coarse = quickMaterial(fine);
            const mesh = new THREE.Mesh(part.fine, fine);
            mesh.castShadow = true;
            this._links[part.link].add(mesh);
            const own = { color: fine.color.clone(), opacity: fine.opacity };
            this._parts.push({ mesh, part, fine, coarse, own, link: robot.links[part.link].name });
        }
        this._marks = new LimitMarks(robot);
        this.group.add(...this.joints, this._marks.group);
        this._skeleton = parts?.length ? null : new Skeleton(robot, new THREE.Color(color).convertSRGBToLinear());
        if (this._skeleton) this.group.add(this._skeleton.group);
    }

    /** Take the pose of instance `i` of a frame; `asked` are the joints whose limits matter. */
    update(frame, i, asked) {
        const placements = frame.placements(i);
        this.joints.forEach((joint, j) => place(joint, placements, 7 * j));
        this._skeleton?.update(this.joints);
        this._marks.update(frame.sides(i), asked, this.joints);
    }

    /** Draw see-through, or as a ghost in a colour (CSS, or null), or as the robot is. */
    look(ghost, seeThrough) {
        this._ghost = ghost;
        this._paint();
        for (const { fine, coarse, own } of this._parts) {
            const opacity = ghost ? GHOST : seeThrough ? Math.min(own.opacity, SEE_THROUGH) : own.opacity;
            for (const material of [fine, coarse]) Object.assign(material, { opacity, transparent: opacity < 1 });
            coarse.uniforms.opacity.value = opacity;
        }
    }

    /** Draw in detail, with shadows on itself, or quickly. */
    refine(isFine) {
        for (const { mesh, part, fine, coarse } of this._parts) {
            mesh.geometry = isFine ? part.fine : part.coarse;
            mesh.material = isFine ? fine : coarse;
            mesh.receiveShadow = isFine;
        }
    }

    /** Draw one of the other answers, see-through and without a shadow. */
    fade(opacity) {
        for (const { mesh, fine } of this._parts) {
            Object.assign(fine, { transparent: true, opacity, depthWrite: false });
            mesh.material = fine;
            mesh.castShadow = false;
        }
        this._skeleton?.fade(opacity);
    }

    /** Paint the links with these names red, and only them. */
    redden(names) {
        this._red = names;
        this._paint();
    }

    /** The quick materials share the colours. */
    _paint() {
        for (const { fine, own, link } of this._parts) {
            if (this._red.has(link)) fine.color.copy(RED);
            else if (this._ghost) fine.color.set(this._ghost).convertSRGBToLinear();
            else fine.color.copy(own.color);
        }
    }

    /** The outermost points of the robot's parts, in its own world: Vector3s. */
    corners() {
        const inverse = new THREE.Matrix4();
        this.group.updateWorldMatrix(true, true);
        inverse.copy(this.group.matrixWorld).invert();
        const points = this.joints.slice(1).map((joint) => joint.position.clone());
        if (this._skeleton) points.push(...points.map(({ x, y, z }) => new THREE.Vector3(x, y, z - this._skeleton.depth)));
        for (const { mesh, part } of this._parts) {
            const toRobot = inverse.clone().multiply(mesh.matrixWorld);
            for (const point of outermost(part.coarse, part.first)) points.push(point.clone().applyMatrix4(toRobot));
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
