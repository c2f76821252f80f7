/** The address bar: contains the set-up, so that a link restores it. */

const PAUSE = 250; // [ms] between two changes, because browsers refuse frequent ones

export class Address {
    /** @param open called with the set-up that the address asks for */
    constructor(open) {
        this._open = open;
        const [navigation] = performance.getEntriesByType("navigation");
        // After a reload the session is more recent than the address.
        this._asked = navigation?.type === "reload" ? "" : location.hash.slice(1);
        // Read the event's own address, because the page may have written a newer one since.
        addEventListener("hashchange", (event) => this._open(new URL(event.newURL).hash.slice(1)));
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
