/** Inputs that show the session's state, except while the user edits them. */

const SETTLE = 700; // [ms] after a change during which the session may still report the old value

const MEMORY = 1500; // [ms] during which a requested value is assumed to hold

const busyUntil = new WeakMap();

const isTyped = (element) => element.matches("input[type=number], input[type=text]");

/**
 * Notice which inputs are being edited. Call this once per page.
 *
 * @param refresh called after an edit to show the session's value, because the session does not report a refusal
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

/** Write a value into an input unless it is being edited. */
export function write(element, value) {
    if (isBusy(element)) return;
    if (element.type === "checkbox") {
        if (element.checked !== value) element.checked = value;
    } else if (element.value !== String(value)) {
        element.value = value;
    }
}

/** Recently requested values, on which the next change builds even before the session has confirmed them. */
export class Asked {
    constructor() {
        this._values = new Map();
    }

    /** The value last requested or, after a while, the session's value. */
    now(key, told) {
        const asked = this._values.get(key);
        return asked && performance.now() < asked.until ? asked.value : told;
    }

    ask(key, value) {
        this._values.set(key, { value, until: performance.now() + MEMORY });
        return value;
    }
}

/** The number typed into an input, or null if it is not a number. */
export function typed(element) {
    const value = element.value.trim() === "" ? NaN : Number(element.value);
    return Number.isFinite(value) ? value : null;
}

/** Set the choices of a <select>, [[value, title], …], unless they are the same as before. */
export function offer(select, choices) {
    const said = JSON.stringify(choices);
    if (select.dataset.choices === said) return;
    const { value } = select;
    select.dataset.choices = said;
    select.replaceChildren(...choices.map(([name, title]) => new Option(title, name)));
    if (choices.some(([name]) => name === value)) select.value = value;
}

/** Convert between low…high and a slider's 0…1000, linearly or logarithmically. */
export function scale(low, high, logarithmic) {
    const to = logarithmic ? Math.log : (x) => x;
    const from = logarithmic ? Math.exp : (x) => x;
    return {
        position: (value) =>
            Math.round((1000 * (to(Math.min(Math.max(value, low), high)) - to(low))) / (to(high) - to(low))),
        value: (position) => Number(from(to(low) + (position / 1000) * (to(high) - to(low))).toPrecision(3)),
    };
}
