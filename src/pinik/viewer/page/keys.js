/** Keyboard shortcuts, and the list of them. */

import { byId, make } from "pinik/elements.js";

export class Keys {
    /** @param bindings [{keys, title, act(event)}], with `shown` if the list should name the keys differently */
    constructor(bindings) {
        this._acts = new Map(bindings.flatMap(({ keys, act }) => keys.map((key) => [key, act])));
        byId("keys").append(
            ...bindings.map(({ keys, shown = keys, title }) =>
                make("div", {}, make("dt", {}, ...shown.map((key) => make("kbd", {}, key))), make("dd", {}, title)),
            ),
        );
        document.addEventListener("keydown", (event) => this._press(event));
    }

    _press(event) {
        if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing) return;
        if (document.querySelector("dialog[open]")) return;
        if (isUsedBy(event.target, event.key)) return;
        const act = this._acts.get(event.key) ?? this._acts.get(event.key.toLowerCase());
        if (!act) return;
        event.preventDefault();
        act(event);
    }
}

/** Whether the focused element needs this key itself. */
function isUsedBy(element, key) {
    if (element.matches("select, textarea, input:is([type=number], [type=text], [type=search])")) return true;
    if (element.matches("input[type=range]")) return key.startsWith("Arrow") || key.startsWith("Page");
    return key === " " && element.matches("button, a, summary, input");
}
