/** How far a point of a robot moves for joint speeds of length one: the singular values of its Jacobian's upper half. */

import { THREE } from "pinik/three.js";

/**
 * The columns of the Jacobian of a point's position, for joints with one axis; a floating or planar root does not count.
 *
 * @param robot the `robot` message
 * @param joints Object3Ds at the joints
 * @param joint index of the joint that carries the point
 * @param point Vector3
 * @returns Vector3s in m/rad, or m/m for joints that slide
 */
export function jacobian(robot, joints, joint, point) {
    const columns = new Map();
    for (let j = joint; j > 0; j = robot.joints[j].parent) {
        const { axis, kind, follows, multiplier } = robot.joints[j];
        if (!axis) continue;
        const way = new THREE.Vector3(...axis).applyQuaternion(joints[j].quaternion);
        const column = kind === "prismatic" ? way : way.cross(point.clone().sub(joints[j].position));
        const moves = follows ?? j; // a follower moves with its leader
        columns.set(moves, (columns.get(moves) ?? new THREE.Vector3()).addScaledVector(column, multiplier));
    }
    return [...columns.values()];
}

/** The three singular values of columns (Vector3s), the largest first, and their directions: {values, ways}. */
export function singular(columns) {
    const entry = (i, k) => columns.reduce((sum, column) => sum + column.getComponent(i) * column.getComponent(k), 0);
    const matrix = [0, 1, 2].map((i) => [0, 1, 2].map((k) => entry(i, k)));
    const ways = [0, 1, 2].map((i) => [0, 1, 2].map((k) => Number(i === k)));
    for (let sweep = 0; sweep < 12; sweep++) {
        for (const [i, k] of [
            [0, 1],
            [0, 2],
            [1, 2],
        ])
            rotate(matrix, ways, i, k);
    }
    const order = [0, 1, 2].sort((i, k) => matrix[k][k] - matrix[i][i]);
    return {
        values: order.map((i) => Math.sqrt(Math.max(matrix[i][i], 0))),
        ways: order.map((i) => new THREE.Vector3(...ways.map((row) => row[i]))),
    };
}

/** One of Jacobi's rotations, which brings the entry i, k of a symmetric matrix to zero. */
function rotate(matrix, ways, i, k) {
    if (Math.abs(matrix[i][k]) < 1e-15) return;
    const slope = (matrix[k][k] - matrix[i][i]) / (2 * matrix[i][k]);
    const t = (slope < 0 ? -1 : 1) / (Math.abs(slope) + Math.hypot(slope, 1));
    const c = 1 / Math.hypot(t, 1);
    const s = t * c;
    for (const row of [...matrix, ...ways]) [row[i], row[k]] = [c * row[i] - s * row[k], s * row[i] + c * row[k]];
    for (let m = 0; m < 3; m++) {
        const [a, b] = [matrix[i][m], matrix[k][m]];
        matrix[i][m] = c * a - s * b;
        matrix[k][m] = s * a + c * b;
    }
}
