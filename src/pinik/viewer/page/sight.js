/** Keeps everything that matters in the picture, and the picture no larger than that needs by far. */

import { Extent } from "pinik/extent.js";
import { THREE } from "pinik/three.js";

const LOOK = 300; // [ms] between two checks for something that left the picture
const LOOSE = 0.25; // the part of the framed size below which everything is looked at again, larger
const HALO = 1.7; // the ring around a selected ball, in radii of the ball

export class Sight {
    /** @param show the scene */
    constructor(show) {
        this._show = show;
        this._extent = new Extent();
        this._curves = new Extent();
        this._looked = 0;
        this._framed = 0;
        this._pending = false;
    }

    /** Forget what had to be seen so far, because the robot or its motion has changed. */
    forget() {
        this._extent.clear();
    }

    /** Keep in the picture where robots and balls are now. */
    remember() {
        this._visit();
        this._extent.add(this._balls());
    }

    _visit() {
        this._extent.add(this._show.cast.instances.flatMap((instance) => instance.robot.corners()));
    }

    /** The outermost points of the balls and their rings, in an instance's own world. */
    _balls() {
        const { balls, cast, state } = this._show;
        return state.balls.flatMap(({ mode }, k) => {
            const position = balls.places[k]?.position;
            if (mode === "off" || !position) return [];
            return Array.from({ length: 6 }, (_, way) => {
                const out = (way < 3 ? 1 : -1) * HALO * cast.ballRadius;
                return position.clone().setComponent(way % 3, position.getComponent(way % 3) + out);
            });
        });
    }

    /** Look at everything as soon as nothing is being dragged. */
    ask() {
        this._pending = true;
    }

    /** Break off the camera's way, and look at everything once nothing is dragged any more. */
    wait() {
        if (this._show.camera.stop()) this.ask();
    }

    /** The outermost points that robots have visited, and the balls' curves, in an instance's own world. */
    get visited() {
        const { state } = this._show;
        if (this._curvesOf !== state) {
            this._curvesOf = state;
            this._curves.clear();
            for (const { mode, curve } of state.balls) if (mode !== "off") this._curves.add(sparse(curve));
        }
        return [...this._extent.points, ...this._curves.points];
    }

    get pending() {
        return this._pending;
    }

    /** Look at everything, smoothly or at once. */
    all(smoothly, preset) {
        const { camera, cast, stage } = this._show;
        this._pending = false;
        [camera.caption, camera.buttons] = this._show.taken;
        const points = this._points();
        this._framed = sizeOf(points);
        camera.frame(points, cast.instances.length, preset, smoothly);
        const { center, radius } = camera.sphere;
        stage.ground.lay(cast.ground, center.x, center.y, radius, cast.robot.size);
    }

    /**
     * Look at everything again if something left the picture, or came back from far away, unless the user turned the
     * camera or drags a ball.
     */
    follow(now) {
        const { camera, busy } = this._show;
        if (busy) return;
        if (this._pending) {
            this.all(true, camera.preset);
            return;
        }
        if (now - this._looked < LOOK || camera.moved || camera.gliding) return;
        this._looked = now;
        const points = this._points();
        if (this._someLeft(points) || sizeOf(points) < LOOSE * this._framed) this.all(true, camera.preset);
    }

    _someLeft(points) {
        const { camera, cast, stage } = this._show;
        if (cast.instances.length > 1 && camera.isCrowded(points)) return true;
        return cast.instances.some((_, i) =>
            points.some((point) => camera.isOutside(stage.project(point.clone().add(cast.offset(i))))),
        );
    }

    /** The points of an instance that should be seen, in its own world. */
    _points() {
        const { state, also } = this._show;
        this._visit();
        const points = [...this._extent.points, ...also, ...this._balls()];
        for (const { mode, curve } of state.balls) if (mode !== "off") points.push(...sparse(curve));
        for (const obstacle of state.obstacles ?? []) points.push(...cornersOf(obstacle));
        return points;
    }
}

/** The radius of a sphere around points [m]. */
function sizeOf(points) {
    return new THREE.Sphere().setFromPoints(points).radius;
}

/** The corners of the box around an obstacle, as Vector3s. */
function cornersOf({ kind, size, position }) {
    const halves = kind === "box" ? size.map((edge) => edge / 2) : Array(3).fill(size[0]);
    return [-1, 1].flatMap((x) =>
        [-1, 1].flatMap((y) =>
            [-1, 1].map((z) => new THREE.Vector3(...[x, y, z].map((side, k) => position[k] + side * halves[k]))),
        ),
    );
}

/** Every fourth point of a curve, as Vector3s. */
function sparse(curve) {
    return curve.filter((_, j) => j % 4 === 0).map((point) => new THREE.Vector3(...point));
}
