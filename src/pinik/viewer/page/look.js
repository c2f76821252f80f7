/** What the "Show" menu adds to the picture, for all instances, and what the session sent for it. */

import { Names } from "pinik/names.js";
import { Shapes } from "pinik/shapes.js";
import { THREE } from "pinik/three.js";

export class Look {
    /** @param show the scene */
    constructor(labels, show) {
        this._show = show;
        this._names = new Names(labels, show);
        this._hulls = new Shapes(show.stage.viewer, "collisions");
        this.on = [];
        this.forget();
    }

    /** Forget what belongs to the last robot. */
    forget() {
        this._hulls.clear();
        for (const { geometry } of this._clouds?.values() ?? []) geometry.dispose();
        this._clouds = new Map();
        this._extras = { collisions: null, reach: null };
    }

    has(name) {
        return this.on.includes(name);
    }

    setState({ looks = [], balls }) {
        this.on = looks;
        const wanted = balls.flatMap(({ frame, mode }) => (mode === "off" ? [] : (this._clouds.get(frame) ?? [])));
        const { reach } = this._extras;
        if (wanted.length !== reach?.length || wanted.some((cloud, k) => cloud !== reach[k]))
            this._extras.reach = wanted.length ? wanted : null;
        this.apply();
    }

    /** Show all instances as the looks ask for. */
    apply() {
        for (const instance of this._show.cast.instances) {
            instance.setLook(this.on, this._extras, this._show.overlaid);
        }
        this._show.stage.touch();
    }

    /** Take a `collisions` message. */
    setCollisions(message) {
        this._extras.collisions = this._hulls.parts(message);
        this.apply();
    }

    /** Take a `reach` message. */
    setReach({ frame, joint, points }) {
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute("position", new THREE.Float32BufferAttribute(points.flat(), 3));
        this._clouds.set(frame, { joint, geometry });
        this.setState(this._show.state);
    }

    /** After each drawing. */
    place() {
        this._names.place(this.has("names"));
    }
}
