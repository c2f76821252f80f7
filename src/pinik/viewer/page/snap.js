/** Snapping while Ctrl (or ⌘) is held: lengths to a centimetre, angles to 15°. */

const LENGTH = 0.01; // [m]
const ANGLE = Math.PI / 12; // [rad]

const rounded = (value, step) => Math.round(value / step) * step;

const snaps = (event) => event.ctrlKey || event.metaKey;

/** Snap a position (a Vector3), in place, while the key is held; with Shift, only along the horizontal axes. */
export function snapPosition(position, event) {
    if (!snaps(event)) return position;
    for (const axis of event.shiftKey ? ["x", "y"] : ["x", "y", "z"]) position[axis] = rounded(position[axis], LENGTH);
    return position;
}

export function snapAngle(angle, event) {
    return snaps(event) ? rounded(angle, ANGLE) : angle;
}
