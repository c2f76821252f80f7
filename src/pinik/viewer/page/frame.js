/** One frame of the session (docs/live-protocol.md). Its parts are views into the numbers, not copies. */

const MAGIC = [0x50, 0x4e, 0x4b, 0x46]; // "PNKF"
const HEAD = 5;
const PLACEMENT = 7;
const FIGURES = 8;

/** Whether binary data is a frame rather than a meshcat command. */
export function isFrame(bytes) {
    return MAGIC.every((byte, k) => bytes[k] === byte);
}

export class Frame {
    /** @param {ArrayBuffer} buffer with or without the four magic bytes */
    constructor(buffer) {
        const start = isFrame(new Uint8Array(buffer, 0, 4)) ? 4 : 0;
        const numbers = new Float32Array(buffer, start);
        [this.generation, , this.instances, this.joints, this.balls] = numbers;
        [this.step] = new Uint32Array(buffer, start + 4, 1); // the only whole number
        this.numbers = numbers;
        this._first = HEAD + PLACEMENT * this.balls;
        this._stride = FIGURES + (PLACEMENT + 1) * this.joints + 3 * this.balls;
    }

    _part(instance, offset, size) {
        const start = this._first + instance * this._stride + offset;
        return this.numbers.subarray(start, start + size);
    }

    /** A ball's x, y, z, qx, qy, qz, qw. */
    ball(k) {
        return this.numbers.subarray(HEAD + PLACEMENT * k, HEAD + PLACEMENT * (k + 1));
    }

    figures(instance) {
        const [status, positionError, orientationError, seconds, , , , counted] = this._part(instance, 0, FIGURES);
        return { status, positionError, orientationError, seconds, counted: counted > 0 };
    }

    /** The joints' world placements, seven numbers each. */
    placements(instance) {
        return this._part(instance, FIGURES, PLACEMENT * this.joints);
    }

    /** −1, 0 or +1 for each joint, or 2 for a joint with only one value. */
    sides(instance) {
        return this._part(instance, FIGURES + PLACEMENT * this.joints, this.joints);
    }

    /** The origins of the frames that chase the balls, three numbers each. */
    points(instance) {
        return this._part(instance, FIGURES + (PLACEMENT + 1) * this.joints, 3 * this.balls);
    }

    /** Whether both frames give the same picture, regardless of step and figures. */
    looksLike(other) {
        if (!other || other.numbers.length !== this.numbers.length || other.generation !== this.generation)
            return false;
        for (let k = HEAD; k < this.numbers.length; k++) {
            const isFigure = k >= this._first && (k - this._first) % this._stride < FIGURES;
            if (!isFigure && this.numbers[k] !== other.numbers[k]) return false;
        }
        return true;
    }
}
