/** The silhouette of points: their convex outline in the picture, and how far copies of it must stand apart. */

export class Silhouette {
    /**
     * @param points Vector3s
     * @param axes the unit vectors right and up of the picture
     */
    constructor(points, { right, up }) {
        this._outline = hull(points.map((point) => [point.dot(right), point.dot(up)]));
    }

    /** How wide it is. */
    get width() {
        return extent(this._outline, 0);
    }

    /** How high it is. */
    get height() {
        return extent(this._outline, 1);
    }

    /** How far a copy must stand to the side of it so that the two do not overlap: its longest horizontal chord. */
    get beside() {
        return longestChord(this._outline, 0);
    }

    /** How far a copy must stand above it so that the two do not overlap: its longest vertical chord. */
    get above() {
        return longestChord(this._outline, 1);
    }
}

function extent(outline, along) {
    const values = outline.map((corner) => corner[along]);
    return Math.max(...values) - Math.min(...values);
}

/** The longest chord of a convex polygon along an axis; it begins or ends in a corner. */
function longestChord(outline, along) {
    const across = 1 - along;
    const lengths = outline.map((corner) => {
        const crossings = outline.flatMap((from, k) => {
            const to = outline[(k + 1) % outline.length];
            const [low, high] = [Math.min(from[across], to[across]), Math.max(from[across], to[across])];
            if (corner[across] < low || corner[across] > high) return [];
            if (low === high) return [from[along], to[along]];
            const part = (corner[across] - from[across]) / (to[across] - from[across]);
            return [from[along] + part * (to[along] - from[along])];
        });
        return Math.max(...crossings) - Math.min(...crossings);
    });
    return Math.max(...lengths);
}

/** The corners of the convex hull of points [x, y], in their order around it (Andrew's monotone chain). */
function hull(points) {
    const sorted = [...points].sort(([ax, ay], [bx, by]) => ax - bx || ay - by);
    const half = (chain, [x, y]) => {
        const isRightTurn = ([ax, ay], [bx, by]) => (bx - ax) * (y - ay) - (by - ay) * (x - ax) <= 0;
        while (chain.length > 1 && isRightTurn(chain.at(-2), chain.at(-1))) chain.pop();
        chain.push([x, y]);
        return chain;
    };
    const [lower, upper] = [sorted.reduce(half, []), sorted.reduceRight(half, [])];
    return [...lower.slice(0, -1), ...upper.slice(0, -1)];
}
