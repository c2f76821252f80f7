/** Where the instances stand: in one row, or in two rows if that shows them much larger. */

import { axesOf, fit } from "pinik/framing.js";
import { THREE } from "pinik/three.js";

const WORTH = 1.25; // how much nearer two rows must bring the camera, because one row is easier to compare
const WORTH_TILTING = 2.2; // the same where two rows would tilt a view from the front or the side
const STEEP = 0.5; // [rad] the least elevation of the camera for two rows
const GAP = 0.04; // between neighbours, as a fraction of the width that they have ever covered
const SLENDER = 0.5; // the least width of a column, as a fraction of a robot's height, where there is room for it
const STEP_BACK = 0.85; // between two rows, as a fraction of what would separate them completely
const FROM_ABOVE = 0.9; // the sine of the elevation from which rows are separated completely

/**
 * Arrange `count` copies of points (Vector3s) in a view.
 *
 * @param lens the lens for `fit`, a function of the number of rows
 * @returns {offsets, view, camera, everything, rows, column}, with camera from `fit` and the distance of columns
 */
export function arrange(points, count, view, lens) {
    const row = candidate(points, count, count, view, lens(1));
    if (count === 1) return row;
    const rows = candidate(points, count, count / 2, { ...view, elevation: Math.max(view.elevation, STEEP) }, lens(2));
    return row.camera.distance > (view.oneRow ? WORTH_TILTING : WORTH) * rows.camera.distance ? rows : row;
}

function candidate(points, count, columns, view, lens) {
    const shape = (lens.left + lens.right) / (lens.top + lens.bottom);
    const { right, up } = axesOf(view);
    const slender = Math.min(SLENDER, (0.95 * shape) / columns);
    const column = Math.max((1 + GAP) * extent(points, right), slender * extent(points, up));
    const offsets = grid(points, count, columns, view, column);
    const everything = offsets.flatMap((offset) => points.map((point) => point.clone().add(offset)));
    return { offsets, view, camera: fit(everything, view, lens), everything, rows: count / columns, column };
}

function grid(points, count, columns, view, column) {
    const { right, up } = axesOf(view);
    const level = new THREE.Vector3(-Math.cos(view.azimuth), -Math.sin(view.azimuth), 0);
    // Seen from above, a row farther back appears higher, because the ground rises in the picture.
    const rise = Math.max(level.dot(up), 0.2);
    const part = rise > FROM_ABOVE ? 1 : STEP_BACK;
    const row = Math.max(part * (extent(points, up) / rise), 0.8 * extent(points, level));
    const rows = Math.ceil(count / columns);
    return Array.from({ length: count }, (_, k) => {
        const [i, j] = [k % columns, Math.floor(k / columns)];
        return new THREE.Vector3()
            .addScaledVector(right, (i - (columns - 1) / 2) * column)
            .addScaledVector(level, ((rows - 1) / 2 - j) * row);
    });
}

/** How far points (Vector3s) extend along an axis. */
export function extent(points, axis) {
    const along = points.map((point) => point.dot(axis));
    return Math.max(...along) - Math.min(...along);
}
