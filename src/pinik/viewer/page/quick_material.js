/** The material of robots drawn by the processor: the same lights, computed per vertex instead of per pixel. */

import { THREE } from "pinik/three.js";

const VERTEX = `
uniform vec3 color, keyWay, fillWay;
uniform vec3 strengths;
varying vec3 skin;
void main() {
    vec4 place = modelMatrix * vec4(position, 1.0);
    vec3 n = normalize(mat3(modelMatrix) * normal);
    // Many files have faces that point inwards.
    if (dot(n, cameraPosition - place.xyz) < 0.0) n = -n;
    vec3 facing = vec3(0.78 + 0.22 * n.y, max(dot(n, keyWay), 0.0), max(dot(n, fillWay), 0.0));
    float light = dot(strengths, facing);
    skin = pow(color * light, vec3(1.0 / 2.2));
    gl_Position = projectionMatrix * viewMatrix * place;
}`;

const FRAGMENT = `
uniform float opacity;
varying vec3 skin;
void main() { gl_FragColor = vec4(skin, opacity); }`;

/** Shared by all of these materials and set by the lights, in the world with y up. */
const lights = {
    keyWay: { value: new THREE.Vector3(0, 1, 0) },
    fillWay: { value: new THREE.Vector3(0, 1, 0) },
    strengths: { value: new THREE.Vector3(0.5, 0.6, 0.2) },
};

/** @param strengths of sky, key and fill light; the ways are unit vectors to the lights */
export function lightQuickMaterials(strengths, keyWay, fillWay) {
    lights.strengths.value.set(...strengths);
    lights.keyWay.value.copy(keyWay);
    lights.fillWay.value.copy(fillWay);
}

/** A material that resembles a MeshStandardMaterial. */
export function quickMaterial({ color, opacity, transparent }) {
    return new THREE.ShaderMaterial({
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        uniforms: {
            color: { value: color },
            opacity: { value: opacity },
            ...lights,
        },
        side: THREE.DoubleSide,
        transparent,
    });
}
