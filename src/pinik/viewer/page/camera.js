/** The camera: presets, framing, and smooth transitions. */

import { axesOf } from "pinik/framing.js";
import { arrange } from "pinik/layout.js";
import { Silhouette } from "pinik/silhouette.js";
import { THREE } from "pinik/three.js";

export const PRESETS = {
    iso: { title: "Angle", azimuth: -0.6, elevation: 0.28 },
    // Two rows need a camera that looks down on them, and would be no view from the front or the side.
    front: { title: "Front", azimuth: 0, elevation: 0.12, oneRow: true },
    side: { title: "Side", azimuth: -Math.PI / 2, elevation: 0.12, oneRow: true },
    top: { title: "Top", azimuth: 0, elevation: Math.PI / 2 - 0.01 },
};

const CROWDED = 1.05; // how much wider robots may become before they are moved apart
const GLIDE = 480; // [ms]
const DRAG = 4; // [px] that a pressed pointer moves before it counts as a drag
const SIDES = 12; // [px] left and right of the robots
const MOST_ABOVE = 1 / 3; // of the picture's height, kept free above the robots
const BESIDE = 14; // [px] between a caption and what is next to it

export class Camera extends EventTarget {
    constructor(stage) {
        super();
        this._stage = stage;
        this._glide = null;
        this.preset = "iso";
        this.moved = false;
        this.offsets = [];
        [this.caption, this.buttons] = [{ w: 200, h: 44 }, 48]; // [px] what captions, and buttons above, need
        [this._view, this.captions, this._apart] = [PRESETS.iso, "below", Infinity];
        this.together = false; // whether all instances stand in one place
        this._calm = matchMedia("(prefers-reduced-motion: reduce)");
        this._watchHand(stage.canvas);
        stage.onTick((now) => this._advance(now));
    }

    /** Notice a drag or a zoom by hand, after which the camera stays where it was put. A click alone is neither. */
    _watchHand(canvas) {
        let pressed = null;
        canvas.addEventListener("pointerdown", ({ clientX: x, clientY: y }) => {
            pressed = { x, y };
        });
        addEventListener("pointermove", ({ clientX: x, clientY: y, buttons }) => {
            if (!buttons) pressed = null;
            if (pressed && Math.hypot(x - pressed.x, y - pressed.y) > DRAG) this._take();
        });
        canvas.addEventListener("wheel", () => this._take());
    }

    _take() {
        if (this.moved) return;
        this._glide = null;
        this.moved = true;
        this.dispatchEvent(new Event("taken"));
    }

    /** Tangents of the half angles that the robots may fill, and of a caption's width. */
    _lens(captions) {
        const { width, height, viewer } = this._stage;
        const half = Math.tan((viewer.camera.fov * Math.PI) / 360);
        const scale = (2 * half) / height; // tangent per pixel
        const part = (size, margin) => Math.max(size / 2 - margin, 10) * scale;
        const { left, right, top, bottom } = this._margins(captions);
        return {
            caption: (this.caption.w + BESIDE) * scale,
            left: part(width, left),
            right: part(width, right),
            top: part(height, top),
            bottom: part(height, bottom),
        };
    }

    /** What is kept free around the robots for buttons and captions [px]. */
    _margins(captions) {
        const { width, height } = this._stage;
        const caption = this.caption.h + BESIDE;
        const side = Math.min(SIDES, width / 4);
        const right = captions === "beside" ? Math.min(side + this.caption.w + BESIDE, width / 2) : side;
        const top = Math.min(this.buttons + (captions === "around" ? caption : 0), MOST_ABOVE * height);
        return { left: side, right, top, bottom: captions === "beside" ? BESIDE : Math.min(caption, height / 4) };
    }

    /** Whether a point of the picture lies in the outer half of what is kept free. */
    isOutside({ x, y }) {
        const { width, height } = this._stage;
        const { left, right, top, bottom } = this._margins(this.captions);
        return x < left / 2 || y < top / 2 || x > width - right / 2 || y > height - bottom / 2;
    }

    /** Whether robots that extend to these points (Vector3s) come into each other's place. */
    isCrowded(points) {
        return !this.together && new Silhouette(points, axesOf(this._view)).beside > CROWDED * this._apart;
    }

    /** Arrange `count` instances and look at them all; `points` (Vector3s) are those of one instance. */
    frame(points, count, preset = this.preset, smoothly = true) {
        if (!points.length || !this._stage.width) return;
        this.preset = preset;
        this.moved = false;
        const arranged = arrange(points, this.together ? 1 : count, PRESETS[preset], (captions) => this._lens(captions));
        const sphere = new THREE.Sphere().setFromPoints(arranged.everything);
        this._stage.lights.aim(sphere.center, 1.05 * sphere.radius, arranged.view.azimuth);
        this.sphere = sphere;
        [this._view, this.captions, this._apart] = [arranged.view, arranged.captions, arranged.apart];
        const goal = {
            ...arranged.view,
            target: arranged.camera.target,
            distance: arranged.camera.distance,
            offsets: this.together ? Array(count).fill(arranged.offsets[0]) : arranged.offsets,
        };
        const began = smoothly && !this._calm.matches && this.offsets.length === count ? performance.now() : -Infinity;
        this._glide = { from: this._now(), to: goal, began };
        this.dispatchEvent(new Event("framed"));
        this._stage.touch();
    }

    get gliding() {
        return this._glide !== null;
    }

    /** Stay where it is on a smooth way; return whether it was on one. */
    stop() {
        if (!Number.isFinite(this._glide?.began)) return false;
        this._glide = null;
        return true;
    }

    /** The camera's pose in the scene's axes. */
    _now() {
        const { camera, controls } = this._stage.viewer;
        const back = zUp(camera.position).sub(zUp(controls.target));
        const distance = back.length();
        return {
            azimuth: Math.atan2(back.y, back.x),
            elevation: Math.asin(Math.min(1, back.z / distance)),
            distance,
            target: zUp(controls.target),
            offsets: this.offsets,
        };
    }

    _advance(now) {
        if (!this._glide) return;
        const { from, to, began } = this._glide;
        const part = Math.min(1, Math.max(0, (now - began) / GLIDE));
        const eased = part === 1 ? 1 : 1 - (1 - part) ** 3;
        const mix = (a, b) => a + (b - a) * eased;
        const turn = ((((to.azimuth - from.azimuth) % (2 * Math.PI)) + 3 * Math.PI) % (2 * Math.PI)) - Math.PI;
        this._put({
            azimuth: from.azimuth + turn * eased,
            elevation: mix(from.elevation, to.elevation),
            distance: Math.exp(mix(Math.log(from.distance), Math.log(to.distance))),
            target: from.target.clone().lerp(to.target, eased),
        });
        this.offsets = to.offsets.map((offset, k) => (from.offsets[k] ?? offset).clone().lerp(offset, eased));
        this.dispatchEvent(new Event("offsets"));
        if (part === 1) this._glide = null;
    }

    _put({ azimuth, elevation, distance, target }) {
        const { camera, controls } = this._stage.viewer;
        const { ahead } = axesOf({ azimuth, elevation });
        controls.target.copy(yUp(target));
        camera.position.copy(yUp(target.clone().addScaledVector(ahead, -distance)));
        this._stage.touch();
    }

    /** The horizontal world axes nearest to "right" and "away" in the picture, as unit vectors, z up. */
    get levelAxes() {
        const { azimuth } = this._now();
        const snapped = Math.round(azimuth / (Math.PI / 2)) * (Math.PI / 2);
        const round = (x, y) => [Math.round(x), Math.round(y), 0];
        return {
            right: round(-Math.sin(snapped), Math.cos(snapped)),
            away: round(-Math.cos(snapped), -Math.sin(snapped)),
        };
    }
}

/** The camera's world has y up, the robots' world has z up. */
function zUp({ x, y, z }) {
    return new THREE.Vector3(x, -z, y);
}

function yUp({ x, y, z }) {
    return new THREE.Vector3(x, z, -y);
}
