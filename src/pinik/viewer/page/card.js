/** One instance in the panel: its method, parameters and message. */

import { make, say } from "pinik/elements.js";
import { offer, write } from "pinik/hands.js";
import { Levels } from "pinik/levels.js";
import { parameterWidget } from "pinik/parameter.js";
import { titled, tone } from "pinik/words.js";

export class Card {
    constructor(index, hello, connection) {
        this._index = index;
        this._connection = connection;
        this._drawn = "";
        this._widgets = [];
        this._title = make("span", { className: "method-name" });
        this._changed = make("span", {
            className: "changed",
            title: "Some parameters differ from their defaults",
            hidden: true,
        });
        this._parameters = make("div", { className: "parameters" });
        this._levels = new Levels(index, () => this._showLevels());
        this._details = make(
            "details",
            { dataset: { testid: `parameters-${index}` } },
            make("summary", { title: "Parameters (p)" }, this._title, this._changed),
            this._parameters,
        );
        this._method = make("select", {
            className: "small",
            dataset: { testid: `method-${index}` },
            aria: { label: `Method of instance ${index + 1}` },
        });
        this._help = new Map(hello.methods.map(({ name, help }) => [name, help]));
        this._method.addEventListener("change", () =>
            connection.send({ type: "method", instance: index, method: this._method.value }),
        );
        this._message = make("p", { className: "message", dataset: { testid: `message-${index}` } });
        this._defaults = make(
            "button",
            { type: "button", className: "soft", dataset: { testid: `defaults-${index}` } },
            "Defaults",
        );
        this._defaults.addEventListener("click", () => this._reset());
        this.element = make(
            "article",
            { className: "card", dataset: { testid: `instance-${index}` } },
            this._method,
            this._details,
            this._message,
        );
        this.element.style.setProperty("--own", `var(--instance-${index})`);
    }

    get open() {
        return this._details.open;
    }

    set open(open) {
        this._details.open = open;
        if (open) this._details.querySelector("summary").focus();
    }

    setState(state) {
        const instance = state.instances[this._index];
        this._instance = instance;
        say(this._title, titled(instance));
        this._title.title = this._help.get(instance.method) ?? "";
        const names = new Set([...state.methods, instance.method]); // its own method, even if it is not on offer
        offer(
            this._method,
            [...names].map((name) => [name, name]),
        );
        write(this._method, instance.method);
        say(this._message, instance.message);
        this._message.title = instance.message;
        this._message.dataset.tone = tone(instance.status);
        this._showParameters(instance, state);
    }

    _showParameters({ method, parameters: given }, state) {
        const parameters = given.toSorted((one, other) => one.level - other.level);
        this._shown = parameters;
        const drawn = [method, ...parameters.map(({ name, kind }) => name + kind)].join();
        if (drawn !== this._drawn) {
            this._drawn = drawn;
            this._widgets = parameters.map((description) => {
                const commit = (value, often) => this._send(description.name, value, often);
                return parameterWidget(description, `param-${this._index}-${description.name}`, commit);
            });
            this._parameters.replaceChildren(
                this._levels.element,
                ...this._widgets.map(({ element }) => element),
                this._defaults,
            );
        }
        parameters.forEach((description, k) => this._widgets[k].show(description, state));
        this._changed.hidden = !parameters.some(differs);
        this._defaults.disabled = this._changed.hidden;
        this._showLevels();
    }

    /** Hide the parameters beyond the chosen level, unless they were changed. */
    _showLevels() {
        this._levels.offer(this._shown);
        this._shown.forEach((description, k) => {
            this._widgets[k].element.hidden = !this._levels.shows(description) && !differs(description);
        });
    }

    _send(name, value, often = false) {
        const message = { type: "parameter", instance: this._index, name, value };
        if (often) this._connection.sendNewest(`${this._index} ${name}`, message);
        else this._connection.send(message);
    }

    _reset() {
        for (const description of this._instance.parameters.filter(differs))
            this._send(description.name, description.default);
    }
}

function differs({ value, default: usual }) {
    return JSON.stringify(value) !== JSON.stringify(usual);
}
