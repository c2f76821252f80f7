/** A line with a width in pixels that always faces the viewer. It can taper towards its beginning. */

import { THREE } from "pinik/three.js";

const VERTEX = `
attribute vec3 before, after;
attribute float side, along;
uniform vec2 resolution;
uniform float width, taper;
varying float vSide, vAlong;
vec2 onScreen(vec4 at) { return at.xy / at.w * resolution; }
void main() {
    mat4 seen = projectionMatrix * modelViewMatrix;
    vec4 here = seen * vec4(position, 1.0);
    vec2 way = onScreen(seen * vec4(after, 1.0)) - onScreen(seen * vec4(before, 1.0));
    way = length(way) > 1e-4 ? normalize(way) : vec2(1.0, 0.0);
    here.xy += vec2(-way.y, way.x) * side * width * mix(1.0, along, taper) / resolution * here.w;
    gl_Position = here;
    vSide = side;
    vAlong = along;
}`;

const FRAGMENT = `
uniform vec3 color;
uniform float opacity, taper;
varying float vSide, vAlong;
void main() {
    float edge = 1.0 - smoothstep(0.55, 1.0, abs(vSide));
    gl_FragColor = vec4(color, opacity * edge * mix(1.0, vAlong * vAlong, taper));
}`;

export class Ribbon {
    /** @param options capacity [points], width [px], opacity, taper (0 or 1) */
    constructor({ capacity, width, opacity, taper = 0 }) {
        this._capacity = capacity;
        this._geometry = new THREE.BufferGeometry();
        for (const name of ["position", "before", "after"]) this._attribute(name, 3);
        for (const name of ["side", "along"]) this._attribute(name, 1);
        const index = Array.from({ length: capacity - 1 }, (_, k) => [
            2 * k,
            2 * k + 1,
            2 * k + 2,
            2 * k + 2,
            2 * k + 1,
            2 * k + 3,
        ]);
        this._geometry.setIndex(index.flat());
        const uniforms = { color: new THREE.Color(), resolution: new THREE.Vector2(1, 1), width, opacity, taper };
        const material = new THREE.ShaderMaterial({
            vertexShader: VERTEX,
            fragmentShader: FRAGMENT,
            uniforms: Object.fromEntries(Object.entries(uniforms).map(([name, value]) => [name, { value }])),
            transparent: true,
            depthWrite: false,
            side: THREE.DoubleSide,
        });
        this.mesh = new THREE.Mesh(this._geometry, material);
        this.mesh.frustumCulled = false;
        this.mesh.renderOrder = 2;
        this.mesh.visible = false;
        // The size of a pixel is known only when the picture is drawn.
        this.mesh.onBeforeRender = (renderer) => {
            renderer.getSize(material.uniforms.resolution.value);
        };
    }

    _attribute(name, size) {
        const attribute = new THREE.BufferAttribute(new Float32Array(2 * this._capacity * size), size);
        attribute.setUsage(THREE.DynamicDrawUsage);
        this._geometry.setAttribute(name, attribute);
    }

    set color(css) {
        this.mesh.material.uniforms.color.value.set(css);
    }

    /** Show the first `count` of points [x, y, z, x, …]. */
    set(points, count) {
        this.mesh.visible = count > 1;
        if (count < 2) return;
        const { position, before, after, side, along } = this._geometry.attributes;
        for (let k = 0; k < count; k++) {
            const neighbours = [
                [position, k],
                [before, Math.max(k - 1, 0)],
                [after, Math.min(k + 1, count - 1)],
            ];
            for (const half of [0, 1]) {
                const vertex = 2 * k + half;
                for (const [attribute, at] of neighbours) {
                    attribute.setXYZ(vertex, points[3 * at], points[3 * at + 1], points[3 * at + 2]);
                }
                side.setX(vertex, half ? 1 : -1);
                along.setX(vertex, k / (count - 1));
            }
        }
        for (const attribute of [position, before, after, side, along]) attribute.needsUpdate = true;
        this._geometry.setDrawRange(0, 6 * (count - 1));
    }

    dispose() {
        this.mesh.parent?.remove(this.mesh);
        this._geometry.dispose();
        this.mesh.material.dispose();
    }
}
