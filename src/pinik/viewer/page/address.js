/** The address bar: carries the set-up, so that a link reopens it. */

export class Address {
    /** @param open called with a set-up that the address asks for */
    constructor(open) {
        this._open = open;
        const [navigation] = performance.getEntriesByType("navigation");
        // After a reload the session knows better than the address what the visitor had last.
        this._asked = navigation?.type === "reload" ? "" : location.hash.slice(1);
        addEventListener("hashchange", () => this._open(location.hash.slice(1)));
    }

    /** Say how things are; the first time, ask for what a link asked for. */
    show(setup) {
        const asked = this._asked;
        this._asked = "";
        if (asked && asked !== setup && decoded(asked) !== decoded(setup)) {
            this._open(asked);
            return;
        }
        if (location.hash.slice(1) !== setup) history.replaceState(null, "", `#${setup}`);
    }
}

function decoded(text) {
    try {
        return decodeURIComponent(text);
    } catch {
        return text;
    }
}
