/** The ground: a fading disc in the theme's colour with a grid and the robots' shadows. */

import { THREE } from "pinik/three.js";

const VERTEX = `
varying vec2 place;
void main() {
    place = (modelMatrix * vec4(position, 1.0)).xz;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const FRAGMENT = `
uniform vec3 floorColor, lineColor;
uniform vec2 center;
uniform float cell, radius, lineStrength;
varying vec2 place;
float lines(float size, float pixels) {
    vec2 at = place / size;
    vec2 width = fwidth(at) * pixels;
    vec2 away = abs(fract(at - 0.5) - 0.5);
    vec2 line = (1.0 - smoothstep(width * 0.4, width, away)) * (1.0 - smoothstep(0.15, 0.5, width));
    return max(line.x, line.y);
}
void main() {
    float far = 1.0 - smoothstep(0.25, 1.0, length(place - center) / radius);
    float line = max(0.5 * lines(cell, 1.2), lines(5.0 * cell, 1.5)) * lineStrength;
    gl_FragColor = vec4(mix(floorColor, lineColor, line), far);
}`;

export class Ground {
    constructor() {
        this.group = new THREE.Group();
        this._material = new THREE.ShaderMaterial({
            vertexShader: VERTEX,
            fragmentShader: FRAGMENT,
            uniforms: {
                floorColor: { value: new THREE.Color() },
                lineColor: { value: new THREE.Color() },
                center: { value: new THREE.Vector2() },
                cell: { value: 0.25 },
                radius: { value: 10 },
                lineStrength: { value: 1 },
            },
            transparent: true,
            depthWrite: false,
            extensions: { derivatives: true },
        });
        const disc = new THREE.CircleGeometry(1, 64);
        this._floor = new THREE.Mesh(disc, this._material);
        this._floor.renderOrder = -2;
        const shadow = () => new THREE.ShadowMaterial({ transparent: true, depthWrite: false });
        this._shadows = { fine: shadow(), coarse: shadow() };
        this._shadow = new THREE.Mesh(disc, this._shadows.fine);
        this._shadow.receiveShadow = true;
        this._shadow.renderOrder = -1;
        this.group.add(this._floor, this._shadow);
    }

    paint(theme) {
        const { floorColor, lineColor, lineStrength } = this._material.uniforms;
        floorColor.value.set(theme.color("floor"));
        lineColor.value.set(theme.color("floor-line"));
        lineStrength.value = theme.number("floor-line-strength");
        for (const material of Object.values(this._shadows)) material.opacity = theme.number("shadow");
    }

    refine(fine) {
        this._shadow.material = fine ? this._shadows.fine : this._shadows.coarse;
    }

    /** Lie at a height [m], around a point, under a scene of this size [m]. */
    lay(height, x, y, size, robotSize) {
        const radius = 6 * size;
        this.group.position.set(x, y, height);
        this._floor.scale.set(radius, radius, 1);
        // No shadow falls farther than this, so the shader need not look for one elsewhere.
        this._shadow.scale.set(1.6 * size, 1.6 * size, 1);
        const uniforms = this._material.uniforms;
        uniforms.center.value.set(x, -y); // the shader works in the world with y up
        uniforms.radius.value = radius;
        uniforms.cell.value = niceCell(robotSize / 5);
    }
}

/** The largest of 1, 2 and 5 times a power of ten that does not exceed a length. */
function niceCell(wanted) {
    const power = 10 ** Math.floor(Math.log10(wanted));
    const [factor] = [5, 2, 1].filter((k) => k * power <= wanted);
    return factor * power;
}
