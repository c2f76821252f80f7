/** The robot's shapes: hidden prototypes made by meshcat's commands. All instances share their geometry. */

import { THREE } from "pinik/three.js";

const ROOT = "pinik";
const BLACK = 0.02; // linear; nothing can be seen of parts that are darker
const GREYS = ["#8b95a1", "#a9b1bb", "#737d8a"];
const WHITEST = 0.8; // linear; a whiter robot would look flat in the light

export class Shapes {
    /** @param kind of shapes: "shapes" or "collisions" */
    constructor(viewer, kind) {
        this._viewer = viewer;
        this._path = [ROOT, kind];
        this._coarse = [];
    }

    /** Remove the shapes of the last robot. */
    clear() {
        this._viewer.delete_path(this._path);
        for (const geometry of this._coarse) geometry.dispose();
        this._coarse = [];
    }

    /** Execute one of meshcat's commands, a Uint8Array. */
    command(bytes) {
        this._viewer.handle_command_bytearray(bytes);
        this._viewer.set_property([ROOT], "visible", false);
    }

    /**
     * The parts of a `shapes` or `collisions` message: [{link, fine, coarse, first, material}] with two geometries and
     * the first vertex of the coarse one. Every instance copies the material.
     */
    parts(message) {
        return message.parts.flatMap(({ link, path }) => {
            const found = [];
            this._viewer.scene_tree.find(path.split("/").filter(Boolean)).object.traverse((object) => {
                if (!object.isMesh) return;
                const { fine, coarse, first } = levels(object.geometry);
                if (coarse !== fine) this._coarse.push(coarse);
                found.push({ link, fine, coarse, first, material: suited(object.material) });
            });
            return found;
        });
    }
}

/** A geometry in detail, and with few triangles, whose vertices and indices come last. */
function levels(geometry) {
    const { fine, first } = geometry.userData;
    if (!fine) return { fine: geometry, coarse: geometry, first: 0 };
    const coarse = new THREE.BufferGeometry();
    coarse.attributes = geometry.attributes;
    coarse.setIndex(geometry.index);
    coarse.setDrawRange(fine, geometry.index.count - fine);
    geometry.setDrawRange(0, fine);
    return { fine: geometry, coarse, first };
}

/**
 * Paint a robot grey whose file paints everything black, because nothing of it could be seen. Returns what was done, in
 * words, or nothing.
 */
export function lighten(parts) {
    const black = ({ material: { color } }) => Math.max(color.r, color.g, color.b) < BLACK;
    if (!parts.length || !parts.every(black)) return [];
    parts.forEach(({ material }, k) => material.color.set(GREYS[k % GREYS.length]).convertSRGBToLinear());
    return ["Its file paints every part black. It is drawn in greys here, so that it can be seen."];
}

/** Convert a material's colour from sRGB, as robot files have it, to linear light, as three.js needs it. */
function suited(material) {
    const one = (Array.isArray(material) ? material[0] : material).clone();
    one.color = new THREE.Color().copy(one.color).convertSRGBToLinear();
    one.color.setRGB(...one.color.toArray().map((part) => Math.min(part, WHITEST)));
    return one;
}
