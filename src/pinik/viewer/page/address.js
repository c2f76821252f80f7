/** The address bar: contains the set-up, so that a link restores it, and what belongs to this tab alone. */

const PAUSE = 250; // [ms] between two changes, because browsers refuse frequent ones

export class Address {
    /**
     * @param open called with the set-up that the address asks for
     * @param own name → what takes its value, or "" without one: parts of which the session does not know
     */
    constructor(open, own) {
        this._open = open;
        this._own = own;
        this._values = new Map();
        const [navigation] = performance.getEntriesByType("navigation");
        const asked = this._read(location.hash);
        // After a reload the session is more recent than the address.
        this._asked = navigation?.type === "reload" ? "" : asked;
        // Read the event's own address, because the page may have written a newer one since.
        addEventListener("hashchange", (event) => this._open(this._read(new URL(event.newURL).hash)));
    }

    /** The set-up in an address; this tab's own parts are given to those that take them at once. */
    _read(hash) {
        const parts = hash.slice(1).split("&");
        const nameOf = (part) => part.split("=", 1)[0];
        for (const [name, take] of Object.entries(this._own)) {
            const value = parts.find((part) => nameOf(part) === name)?.slice(name.length + 1) ?? "";
            this._values.set(name, value);
            take(value);
        }
        return parts.filter((part) => !(nameOf(part) in this._own)).join("&");
    }

    /** Show the session's set-up; the first time, ask for the set-up that a link contained. */
    show(setup) {
        const asked = this._asked;
        this._asked = "";
        if (asked && asked !== setup && decoded(asked) !== decoded(setup)) {
            this._open(asked);
            return;
        }
        this._setup = setup;
        if (!this._timer) this._write();
    }

    /** Show a part that belongs to this tab; "" leaves it out. */
    showOwn(name, value) {
        this._values.set(name, value);
        if (this._setup !== undefined && !this._timer) this._write();
    }

    _write() {
        this._timer = null;
        const own = [...this._values].filter(([, value]) => value).map(([name, value]) => `&${name}=${value}`);
        const text = this._setup + own.join("");
        if (location.hash.slice(1) === text) return;
        history.replaceState(null, "", `#${text}`);
        this._timer = setTimeout(() => this._write(), PAUSE);
    }
}

function decoded(text) {
    try {
        return decodeURIComponent(text);
    } catch {
        return text;
    }
}
