/** Notices that need no answer: errors, a lost connection, a robot being loaded, warnings. */

import { byId, icon, make, say } from "pinik/elements.js";

const SHOWN = 8000; // [ms]
const GOOD = 4000; // [ms]
const MOST = 3;
const MARGIN = 10; // [px] below and above all notices

const heightOf = (element) => element.getBoundingClientRect().height;

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
        // No more than stand over the figures below the stage, so that they cover no robot.
        const room = heightOf(document.querySelector(".dock")) - 2 * MARGIN;
        while (toasts.children.length > (heightOf(toasts) > room ? 1 : MOST)) toasts.firstChild.remove();
    }

    /** Remove the errors, which are about the last robot. */
    clear() {
        byId("toasts").replaceChildren();
    }

    /** @param command the command that shows the present robot, or null if it was not read from a file */
    setCommand(command) {
        this._command = command;
    }

    connected(on) {
        const banner = byId("banner");
        const again = "Connection lost. Trying again … If the server has ended, start it again";
        if (!on && banner.hidden && this._command)
            banner.replaceChildren(`${again} in a terminal: `, make("code", {}, `${this._command} --port ${location.port}`));
        else if (!on && banner.hidden) banner.replaceChildren(`${again} where you started it.`);
        banner.hidden = on;
        document.documentElement.classList.toggle("offline", !on);
    }

    /** Say what is wrong with the watched file and what is shown meanwhile, or that the file is good again. */
    watched(file) {
        const strip = byId("watched");
        const fault = file?.fault ?? null;
        const before = this._fault ?? null;
        this._fault = fault;
        if (fault) {
            const shown = file.shown ? "the robot as it last was" : "another robot meanwhile";
            say(strip, `${fault}. You see ${shown}.`);
        }
        if (fault === before) return;
        clearTimeout(this._mended);
        if (!fault) {
            say(strip, `${file?.file ?? "The file"} is good again.`);
            this._mended = setTimeout(() => {
                strip.hidden = true;
            }, GOOD);
        }
        strip.classList.toggle("good", !fault);
        strip.hidden = false;
    }

    /** @param words what is being loaded, or "" */
    loading(words) {
        byId("loading").hidden = !words;
        if (words) say(byId("loading-words"), words);
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
