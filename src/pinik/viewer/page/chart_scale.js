/** The vertical axes of charts: logarithmic, and robust to single spikes. */

const USUAL = 0.995; // the share of the values that the axis must hold; the others are marked at its edge

/**
 * Whole decades that hold nearly all values.
 * @param values positive numbers @param mark a value that the axis must hold, or null @param least the fewest decades
 */
export function logarithmicScale(values, mark, least) {
    const usual = values.filter((value) => value > 0).sort((a, b) => a - b);
    const at = (share) => usual[Math.round(share * (usual.length - 1))];
    const ends = usual.length ? [at(1 - USUAL), at(USUAL)] : [];
    const held = mark === null ? ends : [...ends, mark / 10, mark * 10];
    let low = Math.floor(Math.log10(held.length ? Math.min(...held) : 0.001));
    let high = Math.ceil(Math.log10(held.length ? Math.max(...held) : 1));
    if (mark !== null) low = Math.max(low, Math.floor(Math.log10(mark)) - 3); // what is far below the mark is all the same
    for (let up = true; high - low < least; up = !up) up ? (high += 1) : (low -= 1);
    const step = Math.ceil((high - low) / 5);
    const ticks = Array.from({ length: Math.floor((high - low) / step) + 1 }, (_, k) => 10 ** (low + k * step));
    const decades = Array.from({ length: high - low }, (_, k) => low + k);
    return {
        ticks,
        between: step > 1 ? [] : decades.flatMap((decade) => [2, 3, 4, 5, 6, 7, 8, 9].map((n) => n * 10 ** decade)),
        top: 10 ** high,
        part: (value) => Math.min(Math.max((Math.log10(Math.max(value, 1e-300)) - low) / (high - low), 0), 1),
    };
}

/** A tick's number in few characters. */
export function figure(tick) {
    if (tick >= 1e6) return tick.toExponential(0).replace("e+", "e");
    if (tick >= 1000) return `${Number((tick / 1000).toPrecision(2))}k`;
    if (tick >= 0.001 || tick === 0) return String(Number(tick.toPrecision(2)));
    return tick.toExponential(0).replace("e-", "e−");
}
