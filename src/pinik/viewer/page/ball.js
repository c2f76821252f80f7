/** One copy of a ball: a glossy sphere, or a pin if the ball is pinned. */

import { Freedom } from "pinik/freedom.js";
import { THREE } from "pinik/three.js";

const SPHERE = new THREE.SphereGeometry(1, 40, 28);
const NEEDLE = new THREE.ConeGeometry(0.22, 2, 20).rotateX(-Math.PI / 2).translate(0, 0, 1); // tip at the origin
const HEAD = new THREE.SphereGeometry(0.8, 32, 20).translate(0, 0, 2.3);
const HIDDEN = { ring: 0.3, ball: 0.5 }; // the opacity where parts of the robot hide something
const AXIS = new THREE.CylinderGeometry(0.13, 0.13, 3, 12).translate(0, 1.5, 0);
const ARROW = new THREE.ConeGeometry(0.34, 0.8, 16).translate(0, 3.2, 0);
// The arms are drawn along y; these rotations about z and x [rad] turn two of them to x and z.
const AXES = [
    { color: "#e5484d", z: -Math.PI / 2, x: 0 },
    { color: "#3d9a50", z: 0, x: 0 },
    { color: "#3b7ddd", z: 0, x: Math.PI / 2 },
].map(({ color, ...turn }) => ({
    material: new THREE.MeshLambertMaterial({ color: new THREE.Color(color).convertSRGBToLinear() }),
    ...turn,
}));

export class Ball {
    constructor(radius) {
        this.group = new THREE.Group();
        this.group.scale.setScalar(radius);
        this._skin = new THREE.MeshPhongMaterial({ shininess: 110, specular: 0x666666 });
        this._pinSkin = new THREE.MeshPhongMaterial({ shininess: 90, specular: 0x555555 });
        this._veil = new THREE.MeshBasicMaterial({
            ...{ transparent: true, opacity: HIDDEN.ball },
            ...{ depthFunc: THREE.GreaterDepth, depthWrite: false },
        });
        this._sphere = new THREE.Group();
        this._sphere.add(mesh(SPHERE, this._skin), veiled(SPHERE, this._veil));
        this._pin = new THREE.Group();
        this._pinVeil = this._veil.clone();
        for (const part of [NEEDLE, HEAD]) this._pin.add(mesh(part, this._pinSkin), veiled(part, this._pinVeil));
        this._triad = triad();
        [this._halo, this._glow] = [halo(true), halo(false)];
        this._freedom = new Freedom();
        this.group.add(this._sphere, this._pin, this._triad, this._halo, this._glow, this._freedom.group);
    }

    /** @param ball from the state; `selected` and `near` (under the pointer) change its look */
    show({ mode, oriented, free }, selected, near) {
        this.group.visible = mode !== "off";
        this._sphere.visible = mode === "on";
        this._pin.visible = mode === "pinned";
        this._triad.visible = oriented;
        this._freedom.show(free);
        this._halo.visible = this._glow.visible = selected || near;
        this._halo.material.opacity = near ? 1 : 0.75;
        this._glow.material.opacity = HIDDEN.ring;
    }

    paint(theme) {
        for (const skin of [this._skin, this._veil]) skin.color.set(theme.color("ball")).convertSRGBToLinear();
        for (const skin of [this._pinSkin, this._pinVeil]) skin.color.set(theme.color("pin")).convertSRGBToLinear();
        this._freedom.paint(theme);
        for (const ring of [this._halo, this._glow])
            ring.material.color.set(theme.color("halo")).convertSRGBToLinear();
    }

    place(x, y, z, quaternion) {
        this.group.position.set(x, y, z);
        this._triad.quaternion.copy(quaternion);
    }

    dispose() {
        this.group.parent?.remove(this.group);
        this._freedom.dispose();
        for (const skin of [this._skin, this._veil, this._pinSkin, this._pinVeil]) skin.dispose();
        for (const ring of [this._halo, this._glow]) ring.material.dispose();
    }
}

function mesh(geometry, material) {
    const made = new THREE.Mesh(geometry, material);
    made.castShadow = true;
    return made;
}

/** What of a part shows through the robot that hides it. */
function veiled(geometry, material) {
    const made = new THREE.Mesh(geometry, material);
    made.renderOrder = 5;
    return made;
}

function triad() {
    const group = new THREE.Group();
    for (const { material, x, z } of AXES) {
        const arm = new THREE.Group();
        arm.add(mesh(AXIS, material), mesh(ARROW, material));
        arm.rotation.set(x, 0, z);
        group.add(arm);
    }
    return group;
}

let ringMap = null;

/** The ring around a ball; parts of the robot hide it, except for the one that is not `deep`. */
function halo(deep) {
    if (!ringMap) {
        const canvas = Object.assign(document.createElement("canvas"), { width: 128, height: 128 });
        const pen = canvas.getContext("2d");
        pen.lineWidth = 7;
        pen.strokeStyle = "#fff";
        pen.beginPath();
        pen.arc(64, 64, 56, 0, 2 * Math.PI);
        pen.stroke();
        ringMap = new THREE.CanvasTexture(canvas);
    }
    const sprite = new THREE.Sprite(
        new THREE.SpriteMaterial({ map: ringMap, depthTest: deep, depthWrite: false, transparent: true }),
    );
    sprite.scale.setScalar(3.4);
    sprite.renderOrder = 6;
    return sprite;
}
