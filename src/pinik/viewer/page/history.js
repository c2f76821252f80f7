/** Error and time of every step in the last ten seconds, for the charts. */

const SECONDS = 10;

export class History {
    constructor() {
        this.series = [];
        this.now = 0;
    }

    /** @param time [s] of the frame's step in the session */
    add(frame, time) {
        if (this.series.length !== frame.instances || time < this.now || frame.generation !== this._generation) {
            this.series = Array.from({ length: frame.instances }, () => []);
            this._generation = frame.generation;
        }
        this.now = time;
        this.series.forEach((samples, i) => {
            const { positionError, seconds, counted } = frame.figures(i);
            const last = samples[samples.length - 1];
            if (!last || last.time < time)
                samples.push({ time, error: positionError, seconds: counted ? seconds : NaN });
            while (samples[0].time < time - SECONDS) samples.shift();
        });
    }

    get seconds() {
        return SECONDS;
    }
}
