/** The theme: light, dark, or that of the system. The colours are in style.css. */

const ORDER = ["system", "light", "dark"];
const KEY = "pinik-theme";

export class Theme extends EventTarget {
    constructor() {
        super();
        this.choice = remembered();
        this._system = matchMedia("(prefers-color-scheme: dark)");
        this._system.addEventListener("change", () => this._apply());
        addEventListener("storage", ({ key }) => key === KEY && this._remember()); // chosen in another tab, or around
        this._apply();
    }

    get dark() {
        return this.choice === "dark" || (this.choice === "system" && this._system.matches);
    }

    _remember() {
        this.choice = remembered();
        this._apply();
    }

    /** Switch to the next of system, light and dark. */
    turn() {
        this.choice = ORDER[(ORDER.indexOf(this.choice) + 1) % ORDER.length];
        try {
            localStorage.setItem(KEY, this.choice);
        } catch {
            // Without storage, the choice lasts until the page is closed.
        }
        this._apply();
    }

    _apply() {
        document.documentElement.dataset.theme = this.dark ? "dark" : "light";
        this._styles = getComputedStyle(document.documentElement);
        this.dispatchEvent(new Event("change"));
    }

    /** The value of a colour variable in style.css. */
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
