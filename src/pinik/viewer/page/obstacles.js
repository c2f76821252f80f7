/** The obstacles in the scene, a copy around each instance, and how they are dragged. */

import { THREE } from "pinik/three.js";

const BOX = new THREE.BoxGeometry(1, 1, 1);
const SPHERE = new THREE.SphereGeometry(1, 32, 20);
const COLOR = new THREE.Color(0x8b97a6).convertSRGBToLinear();
const TOUCHED = new THREE.Color(0xd7263d).convertSRGBToLinear();

export class Obstacles {
    /** @param show the scene */
    constructor(show) {
        this._show = show;
        this._told = [];
        this._held = null;
        this._groups = new Map();
        show.stage.onTick(() => this._follow());
    }

    setState({ obstacles, instances }) {
        this._told = obstacles;
        this._touching = instances.map(({ touching }) => new Set(touching.flat()));
        this._draw();
    }

    /** Where obstacle `k` is now, also while it is being dragged: a Vector3 in the robot's world. */
    place(k) {
        return this._held?.k === k ? this._held.position : new THREE.Vector3(...this._told[k].position);
    }

    _draw() {
        for (const [instance, group] of this._groups) {
            if (this._show.cast.instances.includes(instance)) continue;
            this._keep(group, 0);
            this._groups.delete(instance);
        }
        this._show.cast.instances.forEach((instance, i) => {
            const group = this._groups.get(instance) ?? this._addGroup(instance);
            this._keep(group, this._told.length);
            this._told.forEach(({ kind, size }, k) => {
                const mesh = group.children[k] ?? this._addMesh(group);
                mesh.geometry = kind === "box" ? BOX : SPHERE;
                if (kind === "box") mesh.scale.set(...size);
                else mesh.scale.setScalar(size[0]);
                mesh.position.copy(this.place(k));
                const isTouched = this._touching[i]?.has(`obstacle ${k + 1}`);
                mesh.material.color.copy(isTouched ? TOUCHED : COLOR);
            });
        });
        this._show.stage.touch();
    }

    _addGroup(instance) {
        const group = new THREE.Group();
        instance.group.add(group);
        this._groups.set(instance, group);
        return group;
    }

    /** Remove all but the first meshes of a group. */
    _keep(group, count) {
        for (const mesh of group.children.slice(count)) {
            group.remove(mesh);
            mesh.material.dispose();
        }
    }

    _addMesh(group) {
        const material = new THREE.MeshLambertMaterial({ transparent: true, opacity: 0.75 });
        const mesh = new THREE.Mesh(BOX, material);
        mesh.castShadow = true;
        group.add(mesh);
        return mesh;
    }

    /** Draw the obstacles of instances that have appeared since the last state. */
    _follow() {
        if (this._told.length && this._show.cast.instances.some((instance) => !this._groups.has(instance))) this._draw();
    }

    // What Grab asks of the things that it drags

    get stage() {
        return this._show.stage;
    }

    get camera() {
        return this._show.camera;
    }

    get cast() {
        return this._show.cast;
    }

    ballInWorld(k, instance) {
        return this.place(k).clone().add(this.cast.offset(instance));
    }

    hold() {
        this._show.hold();
    }

    holdBall(k, position) {
        this._held = { k, position: position.clone() };
        this._draw();
    }

    letGoOfBall(k) {
        this._show.release();
        this._told = this._told.map((told, j) => (j === k ? { ...told, position: this.place(k).toArray() } : told));
        this._held = null;
    }

    ballsOnScreen() {
        if (this._show.busy) return [];
        const { pixel } = this.stage;
        return this._show.cast.instances.flatMap((_, instance) =>
            this._told.map(({ kind, size }, k) => {
                const radius = (kind === "box" ? 0.5 * Math.min(...size) : size[0]) / pixel - 12;
                return { k, instance, radius, at: this.stage.project(this.ballInWorld(k, instance)) };
            }),
        );
    }
}
