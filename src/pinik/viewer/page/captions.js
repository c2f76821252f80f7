/** The texts and positions of the labels below the robots. */

import { Labels } from "pinik/labels.js";
import { tone, verdict } from "pinik/words.js";

const WORDS = 120; // [ms] between two changes of the texts
const BELOW = 8; // [px] below the lowest point of the base

export class Captions {
    constructor(element, stage) {
        this._labels = new Labels(element);
        this._stage = stage;
        this._bases = [];
        this._said = 0;
    }

    setHello(hello) {
        this._statuses = hello.statuses;
    }

    /** Show the results of a state, so that captions, cards and table say the same at any moment. */
    tell(instances, state) {
        if (this._told === state && this._count === instances) return;
        Object.assign(this, { _told: state, _count: instances });
        const texts = state.instances.slice(0, instances).map((instance) => {
            const { title, method, status, position_error, orientation_error } = instance;
            const words = verdict(status, position_error ?? NaN, orientation_error ?? NaN, state);
            return { title, method, words, tone: tone(status) };
        });
        this._labels.set(texts);
        this.place();
    }

    /** Show the results of a recorded frame, but not more often than one can read. */
    say(now, frame, state) {
        if (now - this._said < WORDS) return;
        this._said = now;
        const texts = state.instances.slice(0, frame.instances).map(({ title, method }, i) => {
            const { status, positionError, orientationError } = frame.figures(i);
            const name = this._statuses[status];
            return {
                title,
                method,
                words: state.led?.includes(i) ? "moved by hand" : verdict(name, positionError, orientationError, state),
                tone: tone(name),
            };
        });
        this._labels.set(texts);
        this.place();
    }

    /** @param bases for each instance, the points that its robot stands on, in the scene; Vector3s */
    hang(bases) {
        this._bases = bases;
    }

    place() {
        const anchors = this._bases.map((points) => {
            const seen = points.map((point) => this._stage.project(point));
            const xs = seen.map(({ x }) => x);
            const lowest = Math.max(...seen.map(({ y }) => y));
            return {
                x: (Math.min(...xs) + Math.max(...xs)) / 2,
                y: lowest + BELOW,
                behind: seen.some(({ behind }) => behind),
            };
        });
        if (anchors.length) this._labels.place(anchors, this._stage.width, this._stage.height);
    }
}
