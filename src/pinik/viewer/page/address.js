/** The address bar: carries the set-up, so that a link reopens it. */

const PAUSE = 250; // [ms] between two changes: browsers refuse too many

export class Address {
    /** @param open called with a set-up that the address asks for */
    constructor(open) {
        this._open = open;
        const [navigation] = performance.getEntriesByType("navigation");
        // After a reload the session knows better than the address what the visitor had last.
        this._asked = navigation?.type === "reload" ? "" : location.hash.slice(1);
        // The event's own address: the page may have written a newer one meanwhile.
        addEventListener("hashchange", (event) => this._open(new URL(event.newURL).hash.slice(1)));
    }

    /** Say how things are; the first time, ask for what a link asked for. */
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

    _write() {
        this._timer = null;
        if (location.hash.slice(1) === this._setup) return;
        history.replaceState(null, "", `#${this._setup}`);
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
