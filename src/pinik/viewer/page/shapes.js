/** The robot's shapes: hidden prototypes made by meshcat's commands. All instances share their geometry. */

import { THREE } from "pinik/three.js";

const ROOT = ["pinik", "shapes"];
const WHITEST = 0.8; // linear; a whiter robot would look flat in the light

export class Shapes {
    constructor(viewer) {
        this._viewer = viewer;
    }

    /** Remove the shapes of the last robot. */
    clear() {
        this._viewer.delete_path(ROOT);
    }

    /** Execute one of meshcat's commands, a Uint8Array. */
    command(bytes) {
        this._viewer.handle_command_bytearray(bytes);
        this._viewer.set_property(ROOT, "visible", false);
    }

    /** The parts of a `shapes` message: [{link, geometry, material}]. Every instance copies the material. */
    parts(message) {
        return message.parts.flatMap(({ link, path }) => {
            const found = [];
            this._viewer.scene_tree.find(path.split("/").filter(Boolean)).object.traverse((object) => {
                if (object.isMesh) found.push({ link, geometry: object.geometry, material: suited(object.material) });
            });
            return found;
        });
    }
}

/** Convert a material's colour from sRGB, as robot files have it, to linear light, as three.js needs it. */
function suited(material) {
    const one = (Array.isArray(material) ? material[0] : material).clone();
    one.color = new THREE.Color().copy(one.color).convertSRGBToLinear();
    one.color.setRGB(...one.color.toArray().map((part) => Math.min(part, WHITEST)));
    return one;
}
