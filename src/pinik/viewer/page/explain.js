/** The tab that explains one instance's next iteration. */

import { Bars } from "pinik/bars.js";
import { icon, make, say } from "pinik/elements.js";
import { formulas } from "pinik/formulas.js";
import { GainCurve } from "pinik/gain_curve.js";
import { HeatMap } from "pinik/heat_map.js";
import { TurnList } from "pinik/turn_list.js";
import { called, degrees, length } from "pinik/words.js";

const VALUES = {
    jt: ["α", "the step length that leaves the smallest linear residual"],
    pinv: ["τ", "singular values up to here are dropped"],
    dls: ["λ", "the damping; the gain is largest at σ = λ"],
};
const SENTENCES = {
    ccd: "Joint after joint, from the tip to the base, turns the effector as near to the ball as its circle allows. " +
        "In 𝐩, the index c is for the way from the joint to the effector, and d for the way to the ball; 𝐚 is the joint’s axis.",
    jt: "Every joint moves in proportion to how much it would help alone: down the gradient, with one factor α for all.",
    pinv: "The shortest step that removes the whole linear residual. A small σ makes its gain 1/σ large.",
    dls: "Like the pseudo-inverse, but λ holds the gain of small singular values down.",
};

export class Explain {
    /** @param act step(index) takes one iteration, choose(index) asks for another instance, select(index, turn) */
    constructor(theme, { step, choose, showTurn }) {
        this.index = 0;
        this._choose = choose;
        this._pick = make("div", { className: "segments", role: "group", aria: { label: "Which robot is explained" } });
        this._step = make("button", { type: "button", className: "soft", title: "Take one iteration (.)", dataset: { testid: "iterate" } }, icon("step"), "One iteration");
        this._step.addEventListener("click", () => step(this.index));
        this._reason = make("p", { className: "reason", dataset: { testid: "explain-reason" } });
        this._sentence = make("p", { className: "sentence" });
        this._formulas = make("div", { className: "formulas", dataset: { testid: "formulas" } });
        this._value = make("p", { className: "value", dataset: { testid: "explain-value" } });
        this._errors = make("p", { className: "errors", dataset: { testid: "explain-errors" } });
        this._curve = new GainCurve();
        this._heat = new HeatMap(theme);
        this._turns = new TurnList((turn, part) => showTurn(this.index, turn, part));
        const change = (value) => (Math.abs(value) < 1e-9 ? "0" : degrees(value));
        this._values = new Bars({ title: "Singular values: what is left of the error along each", signed: false, words: percentage });
        this._gradient = new Bars({ title: "Gradient Jᵀe", signed: true, words: (v) => (Math.abs(v) < 1e-9 ? "0" : v.toPrecision(2)) });
        this._steps = new Bars({ title: "This step", signed: true, words: change });
        this._freedom = new Bars({ title: "", signed: false, words: (v) => `${Math.round(100 * v)} %` });
        this._values.element.classList.add("with-notes");
        this._body = make("div", { className: "explained" }, this._sentence, this._formulas, this._value, this._curve.element,
            this._turns.element, this._values.element,
            make("section", {}, make("h4", {}, "Jacobian J, residual e and step Δq"), this._heat.element),
            this._gradient.element, this._steps.element, this._freedom.element);
        this.element = make("div", { className: "explain" },
            make("div", { className: "line" }, this._pick, this._step), this._reason, this._errors, this._body);
    }

    setState(state) {
        const names = state.instances.map(called);
        if (this.index >= names.length) this.choose(0);
        if (this._names === names.join()) return;
        this._names = names.join();
        this._pick.replaceChildren(...names.map((name, i) => {
            const button = make("button", { type: "button", dataset: { testid: `explain-${i}` } }, make("span", { className: "dot" }), name);
            button.style.setProperty("--own", `var(--instance-${i})`);
            button.addEventListener("click", () => i === this.index || this.choose(i));
            return button;
        }));
        this._markPick();
    }

    choose(index) {
        this.index = index;
        this.forget();
        this._markPick();
        this._choose(index);
    }

    _markPick() {
        [...this._pick.children].forEach((button, i) => { button.ariaPressed = String(i === this.index); });
    }

    /** Show nothing until the next explanation, because what is shown is of another robot or instance. */
    forget() {
        this._body.hidden = this._errors.hidden = this._reason.hidden = true;
        this._turns.show([], false);
    }

    /** @param explained the `explanation` message @param running whether the session runs */
    show(explained, running) {
        if (explained.instance !== this.index) return;
        this._body.hidden = this._errors.hidden = explained.reason !== null;
        this._reason.hidden = explained.reason === null;
        say(this._reason, explained.reason ?? "");
        if (explained.reason !== null) {
            this._turns.show([], false);
            return;
        }
        this._showWords(explained);
        this._turns.show(explained.turns, running);
        this._curve.show(explained);
        this._heat.show(explained);
        this._showBars(explained);
    }

    _showWords({ method, value, residual, predicted, after, reached, turns, largest, asked }) {
        if (this._method !== method) {
            this._method = method;
            this._formulas.replaceChildren(...formulas(method));
            say(this._sentence, SENTENCES[method] ?? "A method of your own: its Jacobian, and the step that it takes.");
        }
        const [name, meaning] = VALUES[method] ?? [];
        this._value.hidden = !name || value === null;
        this._value.replaceChildren(make("b", {}, `${name} = ${rounded(value ?? 0)}${method === "jt" ? "" : " m"}`), ` ${meaning}`);
        const most = Math.max(0, ...asked.map(Math.abs));
        const clamped = largest !== null && most > largest ? ` The step is shortened: ${degrees(most)} asked, ${degrees(largest)} allowed.` : "";
        const promise = turns.length ? "" : ` (the linear model promises ${length(predicted)})`;
        say(this._errors, reached ? "Reached: no iteration follows." : `Next: ${length(residual)} → ${length(after)}${promise}.${clamped}`);
    }

    _showBars({ method, columns, step, gradient, sigma, parts, gains, freedom, nullity, turns }) {
        const named = (values) => columns.map((name, k) => ({ name, value: values[k] }));
        this._steps.show(turns.length ? [] : named(step));
        this._gradient.show(method === "jt" ? named(gradient) : []);
        // g σ is the share of a residual that the step removes, so what is left is 1 − g σ.
        this._values.show(gains.length ? sigma.map((s, i) => ({
            name: `σ${subscript(i + 1)} = ${Number(s.toPrecision(3))} m`,
            value: Math.abs(1 - gains[i] * s),
            note: ` of ${length(Math.abs(parts[i]))}`,
        })) : [], 1);
        this._freedom.element.querySelector("h4").textContent = nullity
            ? `Null space: ${nullity} dimension${nullity > 1 ? "s" : ""}. Each joint's share that moves no effector`
            : "Null space: none; every motion of a joint moves an effector";
        this._freedom.show(named(nullity ? freedom : []), 1);
        this._freedom.element.hidden = false;
    }

    /** Play the turns of the sweep again. */
    replay() {
        this._turns.replay();
    }
}

function rounded(value) {
    return value > 0 && value < 1e-4 ? value.toExponential(2) : String(Number(value.toPrecision(3)));
}

function percentage(part) {
    if (part < 0.001) return "none";
    return `${part < 0.1 ? (100 * part).toFixed(1) : Math.round(100 * part)} %`;
}

function subscript(number) {
    return String(number).replace(/\d/g, (digit) => "₀₁₂₃₄₅₆₇₈₉"[digit]);
}
