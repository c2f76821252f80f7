/** Numbers with units, and an instance's result in a few words. */

const NOTHING = "–";

export function significant(value, digits = 3) {
    const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(Math.max(Math.abs(value), 1e-9))));
    return value.toFixed(Math.min(decimals, 3));
}

/** A length [m] in a suitable unit. */
export function length(metres) {
    if (metres === null || !Number.isFinite(metres)) return NOTHING;
    const size = Math.abs(metres);
    if (size >= 1) return `${significant(metres)} m`;
    if (size >= 0.01) return `${significant(metres * 100)} cm`;
    if (size >= 0.0001) return `${significant(metres * 1000, 2)} mm`;
    if (size >= 1e-6) return `${(metres * 1000).toFixed(3)} mm`;
    return "0 mm";
}

export function degrees(radians) {
    if (radians === null || !Number.isFinite(radians)) return NOTHING;
    const value = (radians * 180) / Math.PI;
    const size = Math.abs(value);
    const words = value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : 2);
    return `${Number(words) === 0 ? words.replace("-", "") : words}°`;
}

/** A time [s] in a suitable unit. */
export function duration(seconds) {
    if (seconds === null || !Number.isFinite(seconds)) return NOTHING;
    if (seconds === 0) return "0 µs";
    return seconds < 0.0009995 ? `${significant(seconds * 1e6)} µs` : `${significant(seconds * 1000)} ms`;
}

/** A time [s], in microseconds below a millisecond. */
export function microseconds(seconds) {
    if (seconds === null || !Number.isFinite(seconds)) return NOTHING;
    return seconds < 1e-3 ? `${significant(seconds * 1e6)} µs` : `${significant(seconds * 1000)} ms`;
}

export function count(value) {
    if (value === null || !Number.isFinite(value)) return NOTHING;
    return value >= 100 ? value.toFixed(0) : value.toFixed(1);
}

export function percent(part) {
    if (part === null || !Number.isFinite(part)) return NOTHING;
    return `${(part * 100).toFixed(part < 0.9995 ? 1 : 0)} %`;
}

/** A number for an input, without trailing zeros. */
export function plain(value, decimals) {
    return String(Number(decimals === undefined ? value.toPrecision(6) : value.toFixed(decimals)));
}

/** "free_flyer" as "free flyer". */
export function spaced(name) {
    return name.replaceAll("_", " ");
}

/** The smallest tolerances that apply to a ball of a state: {position, orientation}. */
function tightest({ balls, tolerance }) {
    const asked = balls.filter(({ mode }) => mode !== "off");
    const own = asked.map((ball) => ball.tolerance ?? [tolerance.position, tolerance.orientation]);
    return {
        position: Math.min(...own.flatMap(([position]) => position)),
        orientation: Math.min(...own.map(([, orientation]) => orientation)),
    };
}

/** What an instance, or a runner, is called: short, with what tells it from others of its method. */
export function called({ method, distinction }) {
    return distinction ? `${method}, ${distinction.replaceAll(" = ", "\u00a0=\u00a0")}` : method;
}

/** What an instance is called where there is room: by its method's title, if that tells it from the others. */
export function titled(instance) {
    return instance.distinction ? called(instance) : instance.title;
}

/** What instance `i` does or has reached, in a few words; errors in m and rad, null or NaN if not asked for. */
export function standing(state, i, [status, positionError, orientationError], awaiting) {
    if (awaiting) return "loading its shapes …";
    if (state.led?.includes(i)) return "moved by hand";
    return verdict(status, positionError ?? NaN, orientationError ?? NaN, state);
}

/** How a result is marked, whatever its method's colour: "good", "missed" or "idle". */
export function tone(status) {
    return status === "CONVERGED" ? "good" : status === "IDLE" ? "idle" : "missed";
}

/** A length as the session's messages write it. */
function shortLength(metres) {
    return length(metres).replace(/(\.\d*?)0+ /, "$1 ").replace(". ", " ");
}

/** An angle as the session's messages write it. */
function shortAngle(radians) {
    const value = (radians * 180) / Math.PI;
    return `${value >= 10 ? value.toFixed(0) : Number(value.toPrecision(2))}°`;
}

/** An instance's result, such as "4.1 cm short"; errors in m and rad, not finite if not asked for. */
function verdict(status, positionError, orientationError, state) {
    if (status === "FAILED") return "solver failed";
    if (status === "REFUSED") return "cannot do this";
    if (status === "IDLE") return Number.isFinite(positionError) ? `${shortLength(positionError)} away` : "idle";
    if (status === "CONVERGED") return "reached";
    const tolerance = tightest(state);
    const away = Number.isFinite(positionError) && positionError > tolerance.position;
    const turned = Number.isFinite(orientationError) && orientationError > tolerance.orientation;
    if (away) return `${shortLength(positionError)} short`;
    if (turned) return `${shortAngle(orientationError)} off`;
    return status === "COLLIDING" ? "touches something" : "reached";
}
