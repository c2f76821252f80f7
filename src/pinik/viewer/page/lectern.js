/** Everything to teach with: connects the drawer's tabs with the session's messages and the picture. */

import { Explain } from "pinik/explain.js";
import { Teach } from "pinik/teach.js";
import { TurnMarks } from "pinik/turn_marks.js";

export class Lectern {
    /** @param page the page: connection, show, theme, state */
    constructor(page) {
        this._page = page;
        this._asked = null;
        this._explain = new Explain(page.theme, {
            step: (instance) => page.connection.send({ type: "step_iteration", instance }),
            choose: () => this._ask(),
            showTurn: (instance, turn, part) => this._showTurn(instance, turn, part),
        });
        this._marks = new TurnMarks(page.theme);
        this._teach = new Teach([{ name: "explain", title: "Explain", element: this._explain.element }]);
        this._teach.addEventListener("change", () => this._ask());
    }

    setHello() {
        this._asked = null; // a new connection knows nothing of the old one's requests
        this._ask();
    }

    setState(state) {
        this._running = state.running;
        this._explain.setState(state);
    }

    /** Ask for explanations while their tab can be seen. */
    _ask() {
        const instance = this._teach.shows("explain") ? this._explain.index : null;
        if (instance === null) this._showTurn(0, null);
        if (instance === this._asked) return;
        this._asked = instance;
        this._page.connection.send({ type: "explain", instance });
    }

    explain(explained) {
        if (!this._teach.shows("explain") || explained.generation !== this._page.robot?.generation) return;
        this._explain.show(explained, this._running);
    }

    _showTurn(instance, turn, part) {
        const group = this._page.show.instances[instance]?.group;
        if (turn === null || !group) this._marks.hide();
        else {
            group.add(this._marks.group);
            this._marks.paint(`instance-${instance}`);
            this._marks.show(turn, part);
        }
        this._page.show.stage.touch();
    }

    /** Take one iteration if Explain is open; return whether it is. */
    iterate() {
        if (!this._teach.shows("explain")) return false;
        this._page.connection.send({ type: "step_iteration", instance: this._explain.index });
        return true;
    }

    replay() {
        if (this._teach.shows("explain")) this._explain.replay();
    }

    toggle() {
        this._teach.toggle();
    }
}
