/** The robot's shapes: hidden prototypes that meshcat's commands make, whose geometry every instance shares. */

import { THREE } from "pinik/three.js";

const ROOT = ["pinik", "shapes"];
const WHITEST = 0.8; // linear; a whiter robot would lose its form in the light

export class Shapes {
    constructor(viewer) {
        this._viewer = viewer;
    }

    /** Forget those of the last robot. */
    clear() {
        this._viewer.delete_path(ROOT);
    }

    /** One of meshcat's commands: Uint8Array. */
    command(bytes) {
        this._viewer.handle_command_bytearray(bytes);
        this._viewer.set_property(ROOT, "visible", false);
    }

    /** The parts of a `shapes` message: [{link, geometry, material}], a material for an instance to copy. */
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

/** A robot's own colours are meant as a screen shows them; three.js adds up light. */
function suited(material) {
    const one = (Array.isArray(material) ? material[0] : material).clone();
    one.color = new THREE.Color().copy(one.color).convertSRGBToLinear();
    one.color.setRGB(...one.color.toArray().map((part) => Math.min(part, WHITEST)));
    return one;
}
