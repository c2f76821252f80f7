/** Where a camera must stand so that points fill the picture, in the scene's axes (z up). */

import { THREE } from "pinik/three.js";

/** The unit vectors right, up and ahead of a camera at an azimuth and elevation [rad]. */
export function axesOf({ azimuth, elevation }) {
    const back = new THREE.Vector3(
        Math.cos(elevation) * Math.cos(azimuth),
        Math.cos(elevation) * Math.sin(azimuth),
        Math.sin(elevation),
    );
    const right = new THREE.Vector3(-Math.sin(azimuth), Math.cos(azimuth), 0);
    return { right, up: back.clone().cross(right), ahead: back.negate() };
}

/**
 * The nearest camera from which all points are in the picture.
 *
 * @param points Vector3s
 * @param view azimuth and elevation [rad]
 * @param lens tangents of the half angles that the points may fill: left, right, top, bottom
 * @returns target (at the middle depth of the points), and the distance to it
 */
export function fit(points, view, lens) {
    const { right, up, ahead } = axesOf(view);
    let [r, l, t, b, near, far] = [-Infinity, -Infinity, -Infinity, -Infinity, Infinity, -Infinity];
    for (const point of points) {
        const [x, y, z] = [point.dot(right), point.dot(up), point.dot(ahead)];
        r = Math.max(r, x - lens.right * z);
        l = Math.max(l, -x - lens.left * z);
        t = Math.max(t, y - lens.top * z);
        b = Math.max(b, -y - lens.bottom * z);
        near = Math.min(near, z);
        far = Math.max(far, z);
    }
    const back = Math.min(-(r + l) / (lens.right + lens.left), -(t + b) / (lens.top + lens.bottom));
    const between = (low, high) => (low + high) / 2;
    const x = between(r + lens.right * back, -(l + lens.left * back));
    const y = between(t + lens.top * back, -(b + lens.bottom * back));
    const place = (depth) =>
        new THREE.Vector3().addScaledVector(right, x).addScaledVector(up, y).addScaledVector(ahead, depth);
    const middle = between(near, far);
    return { target: place(middle), distance: middle - back };
}
