/** The texts of the captions, and what they must not cover. */

import { Labels } from "pinik/labels.js";
import { called, standing, titled, tone } from "pinik/words.js";

const BESIDE = 10; // [px] between the buttons and robots
const WORDS = 120; // [ms] between two changes of the texts

export class Captions {
    /** @param show the scene */
    constructor(element, show) {
        this._labels = new Labels(element);
        this._show = show;
        this._said = 0;
        this._toolbar = element.parentElement.querySelector(".views");
        this._toasts = element.parentElement.querySelector(".toasts");
    }

    setHello(hello) {
        this._statuses = hello.statuses;
    }

    /** Show the results of a state, so that captions, cards and table say the same at any moment. */
    tell(instances, state) {
        const { awaiting } = this._show;
        if (this._told === state && this._count === instances && this._awaited === awaiting) return;
        Object.assign(this, { _told: state, _count: instances, _awaited: awaiting });
        const results = state.instances.slice(0, instances);
        this._write(
            state,
            results.map(({ status, position_error, orientation_error }) => [status, position_error, orientation_error]),
        );
    }

    /** Show the results of a recorded frame, but not more often than one can read. */
    say(now, frame, state) {
        if (now - this._said < WORDS) return;
        this._said = now;
        const figures = state.instances.slice(0, frame.instances).map((_, i) => frame.figures(i));
        this._write(
            state,
            figures.map(({ status, positionError, orientationError }) => {
                return [this._statuses[status], positionError, orientationError];
            }),
        );
    }

    /** @param results [status, position error, orientation error] of each instance, errors null or NaN if not asked for */
    _write(state, results) {
        const { awaiting, cast } = this._show;
        const texts = results.map(([status, position, orientation], i) => {
            const instance = state.instances[i];
            const words = standing(state, i, [status, position, orientation], awaiting);
            const note = cast.instances[i]?.note ?? "";
            return { title: titled(instance), name: called(instance), words, tone: tone(status), note };
        });
        this._labels.set(texts);
        this.place();
    }

    /** Read how large the captions are; returns the size {w, h} of the largest one [px]. */
    measure() {
        this._labels.measure();
        return this._labels.size;
    }

    place() {
        const { cast, stage } = this._show;
        const room = { width: stage.width, height: stage.height };
        const spots = cast.instances.map((_, i) => this._spot(i)).filter(Boolean);
        if (spots.length !== cast.instances.length) return;
        if (this._show.overlaid) {
            this._labels.stack(spots, room);
            return;
        }
        const balls = this._show.ballsOnScreen().map(({ at, room: reach }) => ({
            ...{ x: at.x - reach, y: at.y - reach },
            ...{ w: 2 * reach, h: 2 * reach },
        }));
        this._labels.place(spots, balls, room, this._taken(), this._show.camera.captions === "beside");
    }

    /** The rectangle that an instance has covered so far, and the middle of what it stands on [px]. */
    _spot(i) {
        const { cast, stage, visited } = this._show;
        const offset = cast.offset(i);
        const seen = visited.map((point) => stage.project(point.clone().add(offset)));
        const standing = cast.base.map((point) => stage.project(point.clone().add(offset)));
        if (!seen.length || !standing.length) return null;
        const box = around(seen);
        const { x, y, w, h } = around(standing);
        const behind = [...seen, ...standing].some((point) => point.behind);
        return { box, foot: { x: x + w / 2, y: y + h }, behind };
    }

    /** The height from the upper edge to below the buttons [px]. */
    get below() {
        const [buttons] = this._taken();
        return buttons ? buttons.y + buttons.h + BESIDE : 0;
    }

    /** The rectangles of the buttons and of the notices. */
    _taken() {
        if (!this._toolbar) return [];
        const stage = this._show.stage.element.getBoundingClientRect();
        return [this._toolbar, ...(this._toasts?.children ?? [])].map((element) => {
            const { left, top, width: w, height: h } = element.getBoundingClientRect();
            return { x: left - stage.left, y: top - stage.top, w, h };
        });
    }
}

function around(points) {
    const [xs, ys] = [points.map(({ x }) => x), points.map(({ y }) => y)];
    const [x, y] = [Math.min(...xs), Math.min(...ys)];
    return { x, y, w: Math.max(...xs) - x, h: Math.max(...ys) - y };
}
