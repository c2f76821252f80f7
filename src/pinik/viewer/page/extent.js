/** The extent of all points that the robots have visited: the farthest one in each of a few directions. */

const DIRECTIONS = [-1, 0, 1]
    .flatMap((x) => [-1, 0, 1].flatMap((y) => [-1, 0, 1].map((z) => [x, y, z])))
    .filter((way) => way.some(Boolean));

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
        return this._farthest.flatMap(({ point }) => point ?? []);
    }
}
