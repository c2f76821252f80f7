/** The tab with the lessons: prepared scenes, each a link with two sentences. */

import { make } from "pinik/elements.js";

export class Lessons {
    /** @param open called with a lesson's name */
    constructor(open) {
        this._open = open;
        this._list = make("ol", { className: "lessons" });
        this.element = make("div", {},
            make("p", { className: "hint" }, "Each lesson is a link to a scene. It puts robots and balls back first."), this._list);
    }

    setHello({ lessons }) {
        this._list.replaceChildren(...lessons.map(({ name, title, text, setup }) => {
            const link = make("a", { href: `#${setup}`, dataset: { testid: `lesson-${name}` } }, title);
            link.addEventListener("click", (event) => {
                if (event.ctrlKey || event.metaKey || event.shiftKey) return; // opens another tab
                event.preventDefault();
                this._open(name);
                for (const other of this._list.children) other.classList.toggle("now", other === link.parentElement);
            });
            return make("li", {}, link, make("p", {}, text));
        }));
    }
}
