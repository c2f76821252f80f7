/** Where a caption hangs: beside its robot, where it covers the least. */

/** Between a caption and its robot, or the edge of the picture [px]. */
export const EDGE = 8;
const WAYS = ["below", "above", "right", "left"];
const RANK = 500; // [px²] that one way may cover more than the next one before that one is better
const STAY = 300; // [px²] that another way must cover less before a caption moves; less than a rank, so that it returns

/**
 * @param box the rectangle {x, y, w, h} of the robot, and `foot`, the middle of what it stands on [px]
 * @param size {w, h} of the caption
 * @param covers rectangles with the `weight` of covering them
 * @param room {width, height} of the picture
 * @param before the way chosen last, or null
 * @returns {x, y, w, h, way}
 */
export function beside({ box, foot }, size, covers, room, before) {
    let best = null;
    WAYS.forEach((way, rank) => {
        const place = { ...inside(wanted(way, box, foot, size), size, room), ...size, way };
        let cost = rank * RANK - (way === before ? STAY : 0);
        for (const other of covers) cost += other.weight * shared(place, other);
        if (!best || cost < best.cost) best = { ...place, cost };
    });
    return best;
}

function wanted(way, box, foot, { w, h }) {
    const middle = box.y + box.h / 2 - h / 2;
    if (way === "below") return { x: foot.x - w / 2, y: box.y + box.h + EDGE };
    if (way === "above") return { x: box.x + box.w / 2 - w / 2, y: box.y - h - EDGE };
    return way === "right" ? { x: box.x + box.w + EDGE, y: middle } : { x: box.x - w - EDGE, y: middle };
}

function inside({ x, y }, { w, h }, { width, height }) {
    const clamp = (value, most) => Math.max(EDGE, Math.min(value, most - EDGE));
    return { x: clamp(x, width - w), y: clamp(y, height - h) };
}

/** The area [px²] that two rectangles share. */
export function shared(a, b) {
    const along = (from, size) => Math.min(a[from] + a[size], b[from] + b[size]) - Math.max(a[from], b[from]);
    return Math.max(0, along("x", "w")) * Math.max(0, along("y", "h"));
}
