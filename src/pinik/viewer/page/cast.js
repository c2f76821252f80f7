/** A robot's instances, side by side: how many there are, what they show, and the ground that they stand on. */

import { Extent } from "pinik/extent.js";
import { Instance } from "pinik/instance.js";
import { THREE } from "pinik/three.js";

const BALL = 0.025; // a ball's radius, as a fraction of the robot's size
const BASE = 0.12; // as a fraction of the robot's size: the robot stands on what is lower than this above the ground

export class Cast {
    constructor(stage, camera, theme) {
        Object.assign(this, { _stage: stage, _camera: camera, _theme: theme });
        Object.assign(this, { robot: null, parts: null, instances: [], ground: null, base: [] });
        camera.addEventListener("offsets", () => this._move());
        stage.onRefine = (fine) => this.instances.forEach(({ robot }) => robot.refine(fine));
    }

    /** Show another robot, or the same one as its file has changed, which keeps its ground. */
    setRobot(robot) {
        for (const instance of this.instances) instance.dispose();
        Object.assign(this, { robot, parts: null, instances: [] });
        if (!robot.keeps_view) Object.assign(this, { ground: null, base: [] });
        this._stage.recast();
    }

    /** Give the robot its shapes. */
    setParts(parts) {
        this.parts = parts;
        for (const instance of this.instances) instance.setRobot(this.robot, parts, this._stage.fine);
        this.ground = null;
        this._stage.recast();
    }

    /** Show so many instances; returns whether there are new ones. */
    setCount(count) {
        const before = this.instances.length;
        while (this.instances.length > count) this.instances.pop().dispose();
        while (this.instances.length < count) this._add();
        return count > before;
    }

    _add() {
        const instance = new Instance(this._stage.scene, this.instances.length, this._theme);
        instance.setRobot(this.robot, this.parts, this._stage.fine);
        this.instances.push(instance);
        this._move();
    }

    _move() {
        this.instances.forEach((instance, i) => instance.group.position.copy(this.offset(i)));
        this._stage.recast();
    }

    /** The position of instance `i`: a Vector3. */
    offset(i) {
        return this._camera.offsets[i] ?? new THREE.Vector3();
    }

    /** The radius of a ball [m]. */
    get ballRadius() {
        return BALL * this.robot.size;
    }

    /** Show the balls of a state, of which one is selected and one, or none, is pointed at; what touches turns red. */
    setState(state, selected, near) {
        this.instances.forEach((instance, i) => {
            instance.setState(state, this.ballRadius, selected, near);
            instance.robot.redden(new Set((state.instances[i]?.touching ?? []).flat()));
        });
    }

    /** Stand as a frame tells, with the balls in their places. */
    update(frame, places) {
        for (const instance of this.instances) instance.update(frame, places);
        if (this.ground === null) this._findGround();
    }

    /** Put the ground at the lowest point of the robot's first pose. */
    _findGround() {
        const corners = this.instances[0].robot.corners();
        this.ground = Math.min(...corners.map((corner) => corner.z));
        const standing = new Extent();
        standing.add(corners.filter((corner) => corner.z < this.ground + BASE * this.robot.size));
        this.base = standing.points;
        this._move();
    }

    paint() {
        for (const instance of this.instances) instance.paint();
    }

    /** Whether a trail fades, and so looks different at the next step. */
    get fades() {
        return this.instances.some((instance) => instance.fading);
    }

    /** Extend the trails by a frame that is not shown itself. */
    addToTrails(frame) {
        for (const instance of this.instances) instance.addToTrails(frame);
    }

    clearTrails() {
        for (const instance of this.instances) instance.clearTrails();
    }
}
