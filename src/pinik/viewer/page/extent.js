/** The extent of points: the farthest one in each of a few directions. */

import { THREE } from "pinik/three.js";

const DIRECTIONS = [-1, 0, 1]
    .flatMap((x) => [-1, 0, 1].flatMap((y) => [-1, 0, 1].map((z) => [x, y, z])))
    .filter((way) => way.some(Boolean));

/** The extent of all points that the robots have visited. */
export class Extent {
    constructor() {
        this.clear();
    }

    clear() {
        this._farthest = DIRECTIONS.map(() => ({ along: -Infinity, point: null }));
    }

    /** @param points Vector3s, which are kept and not copied */
    add(points) {
        for (const point of points) {
            DIRECTIONS.forEach(([x, y, z], k) => {
                const along = x * point.x + y * point.y + z * point.z;
                if (along > this._farthest[k].along) this._farthest[k] = { along, point };
            });
        }
    }

    get points() {
        return [...new Set(this._farthest.flatMap(({ point }) => point ?? []))];
    }
}

const kept = new WeakMap();

/** The outermost vertices of a geometry, from one of them on: Vector3s, found once and then kept. */
export function outermost(geometry, from = 0) {
    const { position } = geometry.attributes;
    if (!kept.has(position)) {
        const points = DIRECTIONS.map(([x, y, z]) => {
            let [best, most] = [from, -Infinity];
            for (let k = from; k < position.count; k++) {
                const along = x * position.getX(k) + y * position.getY(k) + z * position.getZ(k);
                if (along > most) [best, most] = [k, along];
            }
            return best;
        });
        kept.set(
            position,
            [...new Set(points)].map((k) => new THREE.Vector3().fromBufferAttribute(position, k)),
        );
    }
    return kept.get(position);
}
