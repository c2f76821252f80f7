/** How finely to draw, so that the picture stays fluid also where a processor has to draw it. */

const SLOW = 40; // [ms] between two pictures: coarser
const FAST = 19; // [ms]: finer again
const PAUSE = 300; // [ms] longer than this is no drawing speed, but a pause
const PATIENCE = 12; // pictures before a verdict
const LONG_PATIENCE = 240; // pictures before another try at finer

export class Quality {
    constructor() {
        const finest = Math.min(devicePixelRatio, 2);
        this._levels = [
            { ratio: finest, shadowEvery: 1 },
            { ratio: Math.min(finest, 1), shadowEvery: 2 },
            { ratio: 0.8, shadowEvery: 4 },
            { ratio: 0.6, shadowEvery: 8 },
        ];
        this._level = 0;
        this._tries = 2;
        this._restart();
    }

    get ratio() {
        return this._levels[this._level].ratio;
    }

    get finest() {
        return this._levels[0].ratio;
    }

    /** Whether the picture of this number gets new shadows. */
    shadows(picture) {
        return picture % this._levels[this._level].shadowEvery === 0;
    }

    _restart() {
        this._mean = null;
        this._count = 0;
    }

    /** Take note of the time [ms] between two pictures drawn one after the other; true where the level changed. */
    note(interval) {
        if (interval > PAUSE) return false;
        this._mean = this._mean === null ? interval : 0.85 * this._mean + 0.15 * interval;
        this._count += 1;
        if (this._count >= PATIENCE && this._mean > SLOW && this._level < this._levels.length - 1) {
            return this._go(this._level + 1);
        }
        if (this._count >= LONG_PATIENCE && this._mean < FAST && this._level > 0 && this._tries > 0) {
            this._tries -= 1;
            return this._go(this._level - 1);
        }
        return false;
    }

    _go(level) {
        this._level = level;
        this._restart();
        return true;
    }
}
