/** Light or dark: the system's, or the one that the visitor chose. The colours themselves are in style.css. */

const ORDER = ["system", "light", "dark"];
const KEY = "pinik-theme";

export class Theme extends EventTarget {
    constructor() {
        super();
        this.choice = remembered();
        this._system = matchMedia("(prefers-color-scheme: dark)");
        this._system.addEventListener("change", () => this._apply());
        this._apply();
    }

    get dark() {
        return this.choice === "dark" || (this.choice === "system" && this._system.matches);
    }

    /** The next of system, light and dark. */
    turn() {
        this.choice = ORDER[(ORDER.indexOf(this.choice) + 1) % ORDER.length];
        try {
            localStorage.setItem(KEY, this.choice);
        } catch {
            // Without storage the choice holds until the page is left.
        }
        this._apply();
    }

    _apply() {
        document.documentElement.dataset.theme = this.dark ? "dark" : "light";
        this._styles = getComputedStyle(document.documentElement);
        this.dispatchEvent(new Event("change"));
    }

    /** A colour of style.css by its variable's name, as CSS says it. */
    color(name) {
        return this._styles.getPropertyValue(`--${name}`).trim();
    }

    number(name) {
        return Number(this.color(name));
    }
}

function remembered() {
    try {
        const choice = localStorage.getItem(KEY);
        return ORDER.includes(choice) ? choice : "system";
    } catch {
        return "system";
    }
}
