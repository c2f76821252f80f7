/** A search in a long menu: type a part of a name. The <select> itself stays, and its list opens with a search field. */

import { make } from "pinik/elements.js";

const LONG = 14; // choices from which a menu is searched

/** @param words what the search field is called */
export function makeSearchable(select, words) {
    const finder = new Finder(select, words);
    const open = (event) => {
        if (select.disabled || select.options.length < LONG) return;
        event.preventDefault();
        finder.open();
    };
    select.addEventListener("mousedown", open);
    select.addEventListener("touchend", open);
    select.addEventListener("keydown", (event) => {
        if ([" ", "Enter", "F4"].includes(event.key) || (event.altKey && event.key === "ArrowDown")) open(event);
    });
}

class Finder {
    constructor(select, words) {
        this._select = select;
        this._field = make("input", { type: "text", autocomplete: "off", spellcheck: false, aria: { label: words } });
        this._field.placeholder = words;
        this._field.dataset.testid = `${select.dataset.testid}-search`;
        this._list = make("ul", { role: "listbox", aria: { label: words } });
        this._dialog = make("dialog", { className: "finder", aria: { label: words } }, this._field, this._list);
        document.body.append(this._dialog);
        this._field.addEventListener("input", () => this._fill());
        this._dialog.addEventListener("keydown", (event) => this._press(event));
        this._dialog.addEventListener("click", ({ target }) => {
            const choice = target.closest("li");
            if (choice) this._take(choice.dataset.value);
            else if (target === this._dialog) this._dialog.close();
        });
        this._dialog.addEventListener("close", () => select.focus());
    }

    open() {
        const { left, bottom, top, width } = this._select.getBoundingClientRect();
        this._field.value = "";
        this._fill();
        this._dialog.showModal();
        const room = innerHeight - bottom - 12;
        const below = room > 220 || room > top;
        const wide = Math.max(width, 230);
        this._dialog.style.left = `${Math.max(8, Math.min(left, innerWidth - wide - 8))}px`;
        this._dialog.style.width = `${wide}px`;
        this._dialog.style.top = below ? `${bottom + 3}px` : "auto";
        this._dialog.style.bottom = below ? "auto" : `${innerHeight - top + 3}px`;
        this._dialog.style.maxHeight = `${below ? room : top - 12}px`;
        this._field.focus();
    }

    _fill() {
        const asked = this._field.value.toLowerCase().split(/\s+/).filter(Boolean);
        const options = [...this._select.options].filter(({ value, text }) =>
            value ? asked.every((part) => text.toLowerCase().includes(part)) : false,
        );
        this._list.replaceChildren(
            ...options.map(({ value, text }) => make("li", { role: "option", dataset: { value } }, text)),
        );
        if (!options.length) this._list.append(make("p", {}, "nothing of that name"));
        const own = options.findIndex(({ value }) => value === this._select.value);
        this._mark(asked.length ? 0 : Math.max(own, 0));
    }

    _mark(k) {
        const choices = this._list.querySelectorAll("li");
        this._marked = Math.min(Math.max(k, 0), choices.length - 1);
        choices.forEach((choice, i) => {
            choice.ariaSelected = String(i === this._marked);
        });
        choices[this._marked]?.scrollIntoView({ block: "nearest" });
    }

    _press(event) {
        const way = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 }[event.key];
        event.stopPropagation(); // Escape closes this dialog and nothing else
        if (!way && event.key !== "Enter") return;
        event.preventDefault();
        if (way) this._mark(this._marked + way);
        else this._take(this._list.querySelectorAll("li")[this._marked]?.dataset.value);
    }

    _take(value) {
        this._dialog.close();
        if (value === undefined) return;
        this._select.value = value;
        this._select.dispatchEvent(new Event("change", { bubbles: true }));
    }
}
