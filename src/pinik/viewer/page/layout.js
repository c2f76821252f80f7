/** Where the instances stand: in one row, or in two rows if that shows them larger. */

import { axesOf, fit } from "pinik/framing.js";
import { Silhouette } from "pinik/silhouette.js";
import { THREE } from "pinik/three.js";

// How much nearer two rows must bring the camera, because one row is easier to compare:
const WORTH = 1.15;
const WORTH_TILTING = 1.3; // where they would tilt a view from the front or the side
const WORTH_ABOVE = 1.03; // where rows that are seen from above are no farther away than others
const ABOVE = 1.2; // [rad] the elevation from which a view is one from above
const STEEP = 0.5; // [rad] the least elevation of the camera for two rows
const GAP = 0.02; // between neighbours, as a fraction of what keeps them apart
const SLENDER = 0.5; // the least width of a column, as a fraction of a robot's height, where there is room for it
const NEARER = 0.87; // between two rows, as a fraction of what would keep their convex outlines apart, where one tilts
const ROOM = 0.8; // the least distance of two rows on the ground, as a fraction of a robot's depth
const ROUNDS = 5; // for the room of captions, which depends on how far the camera is

/**
 * Arrange `count` copies of points (Vector3s) in a view.
 *
 * @param lens what `fit` needs and `caption`, the tangent of a caption's width, as a function of the captions' place:
 *     "below" a row, "around" two rows (above the one and below the other), or "beside" the robots
 * @returns {offsets, view, camera, everything, captions, apart}, with camera from `fit` and how far robots are apart
 */
export function arrange(points, count, view, lens) {
    const row = candidate(points, count, 1, view, lens, "below");
    if (count === 1) return row;
    const tilted = { ...view, elevation: Math.max(view.elevation, STEEP) };
    const [around, beside] = ["around", "beside"].map((captions) => candidate(points, count, 2, tilted, lens, captions));
    const rows = beside.camera.distance < around.camera.distance ? beside : around;
    return row.camera.distance > worth(view) * rows.camera.distance ? rows : row;
}

function worth({ elevation, oneRow }) {
    if (elevation > ABOVE) return WORTH_ABOVE;
    return oneRow ? WORTH_TILTING : WORTH;
}

function candidate(points, count, rows, view, lensOf, captions) {
    const [lens, columns, axes] = [lensOf(captions), count / rows, axesOf(view)];
    const silhouette = new Silhouette(points, axes);
    const shape = (lens.left + lens.right) / (lens.top + lens.bottom);
    const slender = Math.min(SLENDER, (0.95 * shape) / columns);
    const apart = Math.max((1 + GAP) * silhouette.beside, slender * silhouette.height);
    const above = (view.elevation > ABOVE ? 1 + GAP : NEARER) * silhouette.above;
    let found = null;
    for (let round = 0; round < (captions === "beside" ? ROUNDS : 1); round++) {
        const column = apart + (captions === "beside" && found ? lens.caption * found.camera.distance : 0);
        const offsets = grid(points, { columns, rows, column, above }, view, axes);
        const everything = offsets.flatMap((offset) => points.map((point) => point.clone().add(offset)));
        found = { offsets, view, camera: fit(everything, view, lens), everything, captions, apart };
    }
    return found;
}

function grid(points, { columns, rows, column, above }, { azimuth }, { right, up }) {
    const level = new THREE.Vector3(-Math.cos(azimuth), -Math.sin(azimuth), 0);
    // Seen from above, a row farther back appears higher, because the ground rises in the picture.
    const rise = Math.max(level.dot(up), 0.2);
    const along = points.map((point) => point.dot(level));
    const row = Math.max(above / rise, ROOM * (Math.max(...along) - Math.min(...along)));
    return Array.from({ length: columns * rows }, (_, k) => {
        const [i, j] = [k % columns, Math.floor(k / columns)];
        return new THREE.Vector3()
            .addScaledVector(right, (i - (columns - 1) / 2) * column)
            .addScaledVector(level, ((rows - 1) / 2 - j) * row);
    });
}
