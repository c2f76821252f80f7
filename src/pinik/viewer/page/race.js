/** The tab with the race: all begin in the same pose, at the same moment, at the same target. */

import { contest } from "pinik/contest.js";
import { make, say } from "pinik/elements.js";
import { Copy } from "pinik/copy.js";
import { called, length, microseconds } from "pinik/words.js";

const LONGEST = 24_000; // [ms] that iterations are watched for
const RULES =
    "Every method solves from the same pose, for the same targets, with the same tolerance and limits. " +
    "Each time is the median of five solves, measured apart and in turn.";

export class RaceTab {
    /** @param acts race(places, seed), lineUp(position), iterate() */
    constructor({ race, lineUp, iterate }) {
        Object.assign(this, { _lineUp: lineUp, _iterate: iterate });
        const start = (testid, words, places) => {
            const button = make("button", { type: "button", className: places ? "primary" : "", dataset: { testid } }, words);
            button.addEventListener("click", () => {
                this._asked = this._contest;
                this._wait(true);
                race(places, Math.floor(Math.random() * 1e6));
            });
            return button;
        };
        this._starts = [start("race-ten", "Ten random targets", 10), start("race-here", "The balls as they are", 0)];
        this._words = make("p", { className: "hint", role: "status", dataset: { testid: "race-words" } }, RULES);
        this._table = make("table", { className: "race-table", dataset: { testid: "race-table" } });
        this._card = make("pre", { className: "card-text", dataset: { testid: "race-card" } });
        this._copy = new Copy(() => this._card.textContent, "race-copy");
        this._watch = make("button", { type: "button", className: "soft", dataset: { testid: "race-watch" } }, "Watch iteration by iteration");
        this._watch.addEventListener("click", () => this._show());
        this._which = make("select", { className: "small", aria: { label: "Target to watch" } });
        this._result = make("div", { hidden: true }, this._table,
            make("div", { className: "line" }, this._which, this._watch),
            make("div", { className: "title" }, make("h4", {}, "Result card"), this._copy.element), this._card);
        this.element = make("div", { className: "race" }, make("div", { className: "pair" }, ...this._starts), this._words, this._result);
    }

    _wait(waits) {
        for (const button of this._starts) button.disabled = waits;
        if (waits) say(this._words, "The race is on …");
    }

    /** An error may have ended the race. */
    fail() {
        if (this._starts[0].disabled) say(this._words, RULES);
        this._wait(false);
    }

    /** The robots can run a race again only as long as they are those that ran it. */
    setState(state) {
        this._contest = contest(state);
        this._offerToWatch();
    }

    _offerToWatch() {
        const over = this._contest !== this._entered;
        this._watch.disabled = over;
        this._watch.title = over ? "The robot, a method or a rule has changed since this race" : "";
        if (over) this.stop();
    }

    setResult(race) {
        this._wait(false);
        this._entered = this._asked;
        this._offerToWatch();
        this._race = race;
        this._result.hidden = false;
        say(this._words, this._sentence(race));
        say(this._card, race.card);
        this._which.replaceChildren(...race.places.map((_, k) => make("option", { value: k }, race.random ? `Target ${k + 1}` : "These balls")));
        this._fill(race);
    }

    _sentence({ runners, places }) {
        const [best] = [...runners].sort((a, b) => b.wins - a.wins);
        if (!best?.wins) return "Nobody arrived.";
        if (places.length === 1) return `${called(best)} arrived first.`;
        return `${called(best)} arrived first at ${best.wins} of ${places.length} targets.`;
    }

    /** One row for each target: who arrived after how many iterations and which time. */
    _fill({ runners, places }) {
        const head = make("tr", {}, make("th", { scope: "col" }, ""), ...runners.map((runner) => make("th", { scope: "col" }, called(runner))));
        const rows = places.map((_, k) => {
            const there = runners.filter(({ finishes }) => finishes[k]?.reached);
            const first = Math.min(...there.map(({ finishes }) => finishes[k].time));
            return make("tr", {}, make("th", { scope: "row" }, String(k + 1)),
                ...runners.map(({ finishes, refusal }) => this._cell(finishes[k], first, refusal)));
        });
        const total = make("tr", { className: "total" }, make("th", { scope: "row" }, "first"),
            ...runners.map(({ wins }) => make("td", {}, String(wins))));
        this._table.replaceChildren(make("thead", {}, head), make("tbody", {}, ...rows, total));
    }

    _cell(finish, first, refusal) {
        if (!finish) return make("td", { title: refusal, className: "missed" }, "–");
        if (!finish.reached) return make("td", { className: "missed", title: `still so far away after ${finish.iterations} iterations` }, `✗ ${length(finish.error)}`);
        const cell = make("td", { className: finish.time === first ? "first" : "" }, microseconds(finish.time), make("small", {}, ` ${finish.iterations}`));
        cell.title = `${finish.iterations} iterations${finish.time === first ? ", the first to arrive" : ""}`;
        return cell;
    }

    /** Line the robots up, and let them all iterate in step, so that one sees who arrives after how many iterations. */
    _show() {
        clearInterval(this._timer);
        const k = Number(this._which.value);
        this._lineUp(this._race.places[k]);
        const most = Math.max(...this._race.runners.map(({ finishes }) => finishes[k]?.iterations ?? 0));
        const pause = Math.max(60, Math.min(400, 6000 / most));
        const stride = Math.ceil((most * pause) / LONGEST); // iterations at a time
        let taken = 0;
        this._timer = setInterval(() => {
            if (taken >= most) {
                clearInterval(this._timer);
                return;
            }
            for (const end = Math.min(taken + stride, most); taken < end; taken++) this._iterate();
            say(this._words, `Iteration ${taken} of ${most}: ${this._arrived(k, taken)}`);
        }, pause);
    }

    _arrived(k, taken) {
        const there = this._race.runners.filter(({ finishes }) => finishes[k]?.reached && finishes[k].iterations <= taken);
        return there.length ? `${there.map(called).join("; ")} arrived.` : "nobody has arrived yet.";
    }

    stop() {
        clearInterval(this._timer);
    }
}
