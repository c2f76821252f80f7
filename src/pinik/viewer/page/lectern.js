/** Everything to teach with: connects the drawer's tabs with the session's messages and the picture. */

import { Explain } from "pinik/explain.js";
import { Lessons } from "pinik/lessons.js";
import { RaceTab } from "pinik/race.js";
import { Teach } from "pinik/teach.js";
import { ThesisTable } from "pinik/thesis_table.js";
import { TurnMarks } from "pinik/turn_marks.js";

export class Lectern {
    /**
     * @param page the page: connection, show, theme, state
     * @param onOpen called with the name of the tab that can be seen now, or "" if the drawer is closed
     */
    constructor(page, onOpen) {
        this._page = page;
        this._asked = null;
        this._explain = new Explain(page.theme, {
            step: (instance) => page.connection.send({ type: "step_iteration", instance }),
            choose: () => this._ask(),
            showTurn: (instance, turn, part) => this._showTurn(instance, turn, part),
        });
        this._marks = new TurnMarks(page.theme);
        const send = (type, fields) => page.connection.send({ type, ...fields });
        this._race = new RaceTab({
            race: (places, seed) => send("race", { places, seed }),
            lineUp: (position) => send("line_up", { position }),
            iterate: () => send("step_iteration", { instance: null }),
        });
        this._lessons = new Lessons((name) => send("lesson", { name }));
        this._thesis = new ThesisTable((number, preset) => {
            send("comparison", { number, preset });
            send("bones", { number, preset });
        });
        this._teach = new Teach([
            { name: "explain", title: "Explain", element: this._explain.element },
            { name: "race", title: "Race", element: this._race.element },
            { name: "lessons", title: "Lessons", element: this._lessons.element },
            { name: "thesis", title: "Table 4.1", element: this._thesis.element },
        ]);
        this._teach.addEventListener("change", () => {
            this._ask();
            onOpen(this._teach.isOpen ? this._teach.shown : "");
        });
    }

    setHello(hello) {
        this._asksAnew = true; // a new connection knows nothing of the old one's requests
        this._lessons.setHello(hello);
        this._thesis.setHello(hello);
        this._race.fail();
    }

    setRobot() {
        this._explain.forget();
    }

    setState(state) {
        this._running = state.running;
        this._explain.setState(state); // which may choose another robot, since fewer are shown
        if (this._asksAnew) {
            [this._asksAnew, this._asked] = [false, null];
            this._ask();
        }
        this._race.setState(state);
        this._thesis.setState(state);
    }

    /** The session's messages that concern the drawer alone. */
    get handlers() {
        return {
            explanation: (explained) => this._show(explained),
            race: (race) => this._race.setResult(race),
            bones: (bones) => this._thesis.setBones(bones),
        };
    }

    /** An error may concern a race. */
    fail() {
        this._race.fail();
    }

    /** Ask for explanations while their tab can be seen. */
    _ask() {
        const instance = this._teach.shows("explain") ? this._explain.index : null;
        if (instance === null) this._explain.forget();
        if (!this._teach.shows("race")) this._race.stop();
        if (instance === this._asked) return;
        this._asked = instance;
        this._page.connection.send({ type: "explain", instance });
    }

    _show(explained) {
        if (!this._teach.shows("explain") || explained.generation !== this._page.robot?.generation) return;
        this._explain.show(explained, this._running);
    }

    _showTurn(instance, turn, part) {
        const group = this._page.show.cast.instances[instance]?.group;
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

    /** Open one of the drawer's tabs, or close the drawer if there is none of that name. */
    open(name) {
        if (this._teach.has(name)) this._teach.open(name);
        else if (this._teach.isOpen) this._teach.close();
    }

    toggle() {
        this._teach.toggle();
    }
}
