/** Soft light from the sky, and a key light whose shadows follow the scene. */

import { lightQuickMaterials } from "pinik/quick_material.js";
import { THREE } from "pinik/three.js";

export class Lights {
    /** @param software whether WebGL runs on the processor */
    constructor(software) {
        this.group = new THREE.Group();
        this._sky = new THREE.HemisphereLight(0xffffff, 0x8d8a86, 0.5);
        this._sky.position.set(0, 0, 1);
        this._key = new THREE.DirectionalLight(0xfff4e6, 0.72);
        this._key.castShadow = true;
        this._key.shadow.mapSize.setScalar(software ? 1024 : 2048);
        this._key.shadow.radius = 3;
        this._fill = new THREE.DirectionalLight(0xdce8ff, 0.2);
        this.group.add(this._sky, this._key, this._key.target, this._fill, this._fill.target);
    }

    paint(theme) {
        this._sky.intensity = theme.number("sky-light");
        this._key.intensity = theme.number("key-light");
        this._fill.intensity = theme.number("fill-light");
        this._lightQuickMaterials();
    }

    /** Light a sphere (z up), seen from an azimuth [rad], from over the viewer's left shoulder. */
    aim(center, radius, azimuth) {
        const along = (angle, height) =>
            new THREE.Vector3(Math.cos(angle), Math.sin(angle), height).setLength(3 * radius);
        for (const [light, from] of [
            [this._key, along(azimuth - 0.7, 1.35)],
            [this._fill, along(azimuth + 1.6, 0.5)],
        ]) {
            light.target.position.copy(center);
            light.position.copy(center).add(from);
        }
        const { shadow } = this._key;
        Object.assign(shadow.camera, {
            left: -radius,
            right: radius,
            top: radius,
            bottom: -radius,
            near: radius,
            far: 6 * radius,
        });
        shadow.camera.updateProjectionMatrix();
        shadow.normalBias = radius * 0.004;
        shadow.bias = -0.0005;
        this._lightQuickMaterials();
    }

    _lightQuickMaterials() {
        // The lights' world has y up.
        const wayTo = ({ position, target }) => {
            const { x, y, z } = position.clone().sub(target.position).normalize();
            return new THREE.Vector3(x, z, -y);
        };
        const strengths = [this._sky, this._key, this._fill].map((light) => light.intensity);
        lightQuickMaterials(strengths, wayTo(this._key), wayTo(this._fill));
    }
}
