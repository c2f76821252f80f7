/** The level of detail, chosen so that the picture stays fluid even without a graphics card. */

const SLOW = 55; // [ms] between two pictures: draw less detail
const FAST = 19; // [ms]: draw more detail again
const PAUSE = 400; // [ms] a longer interval is a pause, not a slow picture
const PATIENCE = 10; // pictures before a decision
const LONG_PATIENCE = 240; // pictures before another try at more detail

export class Quality {
    /** @param software whether WebGL runs on the processor, where antialiasing is as costly as more pixels */
    constructor(software) {
        const sharp = Math.min(devicePixelRatio, 2);
        this._levels = [
            { ratio: sharp, fine: true, shadowEvery: 1 },
            { ratio: Math.min(sharp, 1), fine: true, shadowEvery: 2 },
            { ratio: Math.min(sharp, 1), fine: false, shadowEvery: 3 },
            { ratio: 0.75, fine: false, shadowEvery: 6 },
        ];
        /** The level for a picture that does not change. */
        this.still = { ratio: software ? Math.max(sharp, 1.5) : sharp, fine: true };
        this._level = software ? 2 : 0;
        this._tries = 2;
        this._restart();
    }

    get now() {
        return this._levels[this._level];
    }

    _restart() {
        this._mean = null;
        this._count = 0;
    }

    /** Note the time [ms] between two successive pictures. */
    note(interval) {
        if (interval > PAUSE) return;
        this._mean = this._mean === null ? interval : 0.85 * this._mean + 0.15 * interval;
        this._count += 1;
        if (this._count >= PATIENCE && this._mean > SLOW && this._level < this._levels.length - 1) {
            this._level += 1;
            this._restart();
        } else if (this._count >= LONG_PATIENCE && this._mean < FAST && this._level > 0 && this._tries > 0) {
            this._tries -= 1;
            this._level -= 1;
            this._restart();
        }
    }
}
