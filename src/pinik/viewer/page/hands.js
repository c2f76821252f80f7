/** Inputs that show the session's state, except while the visitor's hands are on them. */

const SETTLE = 700; // [ms] after a change in which the session may still tell how it was before

const MEMORY = 1500; // [ms] in which what was asked for is taken for granted

const busyUntil = new WeakMap();

const isTyped = (element) => element.matches("input[type=number], input[type=text]");

/**
 * Notice which inputs are being edited; once for a page.
 *
 * @param refresh called when hands are off again, to show how things are: what was refused, the session does not tell
 */
export function watchHands(refresh) {
    const later = ({ target }) => {
        busyUntil.set(target, performance.now() + SETTLE);
        setTimeout(refresh, SETTLE + 1);
    };
    document.addEventListener("focusin", ({ target }) => isTyped(target) && busyUntil.set(target, Infinity));
    document.addEventListener("input", (event) => {
        if (isTyped(event.target)) busyUntil.set(event.target, Infinity);
        else later(event);
    });
    document.addEventListener("change", later);
    document.addEventListener("focusout", ({ target }) => {
        if (busyUntil.get(target) !== Infinity) return;
        busyUntil.delete(target);
        setTimeout(refresh);
    });
}

function isBusy(element) {
    return performance.now() < (busyUntil.get(element) ?? 0);
}

/** Write a value into an input, unless it is being edited. */
export function write(element, value) {
    if (isBusy(element)) return;
    if (element.type === "checkbox") {
        if (element.checked !== value) element.checked = value;
    } else if (element.value !== String(value)) {
        element.value = value;
    }
}

/** What was asked for lately: the next change goes on from there, also before the session has told of the last one. */
export class Asked {
    constructor() {
        this._values = new Map();
    }

    /** The value last asked for, or after a while what the session told. */
    now(key, told) {
        const asked = this._values.get(key);
        return asked && performance.now() < asked.until ? asked.value : told;
    }

    ask(key, value) {
        this._values.set(key, { value, until: performance.now() + MEMORY });
        return value;
    }
}

/** The number that was typed into an input, or null where it is none. */
export function typed(element) {
    const value = element.value.trim() === "" ? NaN : Number(element.value);
    return Number.isFinite(value) ? value : null;
}

/** The choices of a <select>: [[value, title], …]; left alone while they stay the same. */
export function offer(select, choices) {
    const said = JSON.stringify(choices);
    if (select.dataset.choices === said) return;
    const { value } = select;
    select.dataset.choices = said;
    select.replaceChildren(...choices.map(([name, title]) => new Option(title, name)));
    if (choices.some(([name]) => name === value)) select.value = value;
}

/** A slider from 0 to 1000 that stands for low to high, logarithmically where that is wanted. */
export function scale(low, high, logarithmic) {
    const to = logarithmic ? Math.log : (x) => x;
    const from = logarithmic ? Math.exp : (x) => x;
    return {
        position: (value) =>
            Math.round((1000 * (to(Math.min(Math.max(value, low), high)) - to(low))) / (to(high) - to(low))),
        value: (position) => Number(from(to(low) + (position / 1000) * (to(high) - to(low))).toPrecision(3)),
    };
}
