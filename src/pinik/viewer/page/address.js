/** The address bar: contains the set-up, so that a link restores it, and whether the page presents. */

const PAUSE = 250; // [ms] between two changes, because browsers refuse frequent ones
const PRESENT = /(^|&)present=on(?=&|$)/; // belongs to this tab, so the session does not know of it

export class Address {
    /**
     * @param open called with the set-up that the address asks for
     * @param present called with whether the address asks for a presentation
     */
    constructor(open, present) {
        this._open = open;
        this._present = present;
        this._presents = false;
        const [navigation] = performance.getEntriesByType("navigation");
        const asked = this._read(location.hash);
        // After a reload the session is more recent than the address.
        this._asked = navigation?.type === "reload" ? "" : asked;
        // Read the event's own address, because the page may have written a newer one since.
        addEventListener("hashchange", (event) => this._open(this._read(new URL(event.newURL).hash)));
    }

    /** The set-up in an address; whether it asks for a presentation is done at once. */
    _read(hash) {
        const text = hash.slice(1);
        this._presents = PRESENT.test(text);
        this._present(this._presents);
        return text.replace(PRESENT, "").replace(/^&/, "");
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

    /** Show whether the page presents. */
    showPresenting(on) {
        this._presents = on;
        if (this._setup !== undefined && !this._timer) this._write();
    }

    _write() {
        this._timer = null;
        const text = this._setup + (this._presents ? "&present=on" : "");
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
