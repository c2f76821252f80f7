/** The drawer to teach with: its tabs, and opening and closing it. */

import { byId, make } from "pinik/elements.js";

export class Teach extends EventTarget {
    /** @param parts [{name, title, element}] in the order of the tabs */
    constructor(parts) {
        super();
        this._parts = parts;
        this._drawer = byId("teach");
        this.shown = parts[0].name;
        this._tabs = parts.map(({ name, title }) => {
            const tab = make("button", { type: "button", role: "tab", id: `tab-${name}`, dataset: { testid: `tab-${name}` } }, title);
            tab.addEventListener("click", () => this.open(name));
            return tab;
        });
        byId("teach-tabs").append(...this._tabs);
        byId("teach-tabs").addEventListener("keydown", (event) => this._walk(event));
        byId("teach-body").append(...parts.map(({ element }) => element));
        for (const { name, element } of parts) {
            element.setAttribute("role", "tabpanel");
            element.setAttribute("aria-labelledby", `tab-${name}`);
        }
        byId("teach-button").addEventListener("click", () => this.toggle());
        byId("teach-close").addEventListener("click", () => this.close());
        this._show();
    }

    get isOpen() {
        return !this._drawer.hidden;
    }

    /** Whether a tab can be seen. */
    shows(name) {
        return this.isOpen && this.shown === name;
    }

    /** Whether there is a tab of this name. */
    has(name) {
        return this._parts.some((part) => part.name === name);
    }

    open(name = this.shown) {
        this.shown = name;
        this._drawer.hidden = false;
        this._show();
    }

    close() {
        this._drawer.hidden = true;
        this._show();
        byId("teach-button").focus({ preventScroll: true });
    }

    /** Open a tab, or close the drawer if that tab is open. */
    toggle(name = this.shown) {
        if (this.shows(name)) this.close();
        else this.open(name);
    }

    /** The arrow keys go from tab to tab. */
    _walk(event) {
        const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
        if (!way) return;
        event.preventDefault();
        event.stopPropagation();
        const at = this._parts.findIndex(({ name }) => name === this.shown);
        const next = (at + way + this._parts.length) % this._parts.length;
        this.open(this._parts[next].name);
        this._tabs[next].focus();
    }

    _show() {
        document.querySelector(".app").classList.toggle("teaching", this.isOpen);
        byId("teach-button").ariaPressed = String(this.isOpen);
        this._parts.forEach(({ name, element }, k) => {
            element.hidden = name !== this.shown;
            this._tabs[k].ariaSelected = String(name === this.shown);
            this._tabs[k].tabIndex = name === this.shown ? 0 : -1;
        });
        this.dispatchEvent(new Event("change"));
    }
}
