/** Notices that need no answer: errors, a lost connection, a robot being loaded, warnings. */

import { byId, icon, make, say } from "pinik/elements.js";

const SHOWN = 8000; // [ms]
const GOOD = 4000; // [ms]

export class Notices {
    error(words) {
        const toasts = byId("toasts");
        if ([...toasts.children].some((toast) => toast.firstChild.textContent === words)) return;
        const close = make("button", { type: "button", className: "quiet", aria: { label: "Dismiss" } }, icon("close"));
        const toast = make("div", { className: "toast" }, make("span", {}, words), close);
        const remove = () => toast.remove();
        close.addEventListener("click", remove);
        setTimeout(remove, SHOWN);
        toasts.append(toast);
        while (toasts.children.length > 3) toasts.firstChild.remove();
    }

    connected(on) {
        byId("banner").hidden = on;
        document.documentElement.classList.toggle("offline", !on);
    }

    /** Say what is wrong with the watched file, or that it is good again. */
    watched(file) {
        const fault = file?.fault ?? null;
        const strip = byId("watched");
        clearTimeout(this._mended);
        if (fault) say(strip, `${fault}. You see the robot as it last was.`);
        else if (this._fault) {
            say(strip, `${file.file} is good again.`);
            this._mended = setTimeout(() => {
                strip.hidden = true;
            }, GOOD);
        }
        strip.classList.toggle("good", !fault);
        if (fault || this._fault) strip.hidden = false;
        else if (!strip.classList.contains("good")) strip.hidden = true;
        this._fault = fault;
    }

    loading(name) {
        byId("loading").hidden = !name;
        if (name) say(byId("loading-words"), `Loading ${name} …`);
    }

    warnings(list) {
        const details = byId("warnings");
        details.hidden = list.length === 0;
        say(
            details.querySelector("summary"),
            list.length === 1 ? "1 note on this robot" : `${list.length} notes on this robot`,
        );
        details.querySelector("ul").replaceChildren(...list.map((words) => make("li", {}, words)));
    }
}
