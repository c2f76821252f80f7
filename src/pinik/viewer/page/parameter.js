/** The inputs for one parameter of a solver, made from its description. */

import { make } from "pinik/elements.js";
import { offer, scale, typed, write } from "pinik/hands.js";
import { JointValues } from "pinik/joint_values.js";
import { plain, spaced } from "pinik/words.js";

/** Make the widget for a description: {element, show(description, state)}. It calls `commit(value)` on a change. */
export function parameterWidget(description, testid, commit) {
    const kinds = { number: numberWidget, truth: truthWidget, choice: choiceWidget, joints: jointsWidget };
    return kinds[description.kind](description, testid, commit);
}

function row(description, control, ...after) {
    const title = make("span", { className: "name" }, spaced(description.name));
    for (const [className, text] of [
        ["symbol", description.symbol],
        ["unit", description.unit],
    ])
        if (text) title.append(" ", make("small", { className }, text));
    const label = make("label", { className: "head", title: description.help }, title, control);
    return make(
        "div",
        { className: `parameter ${description.kind}` },
        label,
        ...after,
        make("p", { className: "help" }, description.help),
    );
}

function numberWidget(description, testid, commit) {
    const { low, high, slider, logarithmic, none } = description;
    const input = make("input", { type: "number", step: "any", dataset: { testid } });
    if (low !== null) input.min = low;
    if (high !== null) input.max = high;
    if (none) input.placeholder = none;
    input.addEventListener("change", () => {
        const value = typed(input);
        if (value !== null) commit(value);
        else if (none && input.value === "") commit(null);
    });
    const extras = [];
    const scaled = slider && scale(slider[0], slider[1], logarithmic);
    const range =
        scaled &&
        make("input", {
            type: "range",
            min: 0,
            max: 1000,
            step: 1,
            aria: { label: `${spaced(description.name)} (slider)` },
        });
    range?.addEventListener("input", () => {
        const value = description.whole
            ? Math.round(scaled.value(Number(range.value)))
            : scaled.value(Number(range.value));
        input.value = plain(value);
        commit(value, true);
    });
    const word = none && make("input", { type: "checkbox" });
    word?.addEventListener("change", () => commit(word.checked ? null : likely(description)));
    if (range || word) {
        const parts = [range ?? "", word ? make("label", { className: "check" }, word, none) : ""];
        extras.push(make("div", { className: "sliding" }, ...parts));
    }
    const show = ({ value }) => {
        write(input, value === null ? "" : plain(value));
        if (word) write(word, value === null);
        if (range) {
            write(range, scaled.position(value ?? likely(description)));
            range.hidden = value === null;
        }
    };
    return { element: row(description, input, ...extras), show };
}

/** The first number after null: the default, or else the middle of the slider. */
function likely({ default: value, slider, logarithmic, low }) {
    return value ?? (slider ? scale(slider[0], slider[1], logarithmic).value(500) : (low ?? 1));
}

function truthWidget(description, testid, commit) {
    const input = make("input", { type: "checkbox", dataset: { testid } });
    input.addEventListener("change", () => commit(input.checked));
    return { element: row(description, input), show: ({ value }) => write(input, value) };
}

function choiceWidget(description, testid, commit) {
    const select = make("select", { dataset: { testid } });
    offer(
        select,
        description.choices.map((choice) => [choice, spaced(choice)]),
    );
    select.addEventListener("change", () => commit(select.value));
    return { element: row(description, select), show: ({ value }) => write(select, value) };
}

function jointsWidget(description, testid, commit) {
    const values = new JointValues(description, testid, commit);
    return {
        element: row(description, values.adder, values.list),
        show: ({ value }, state) => values.show(value, state.joint_names),
    };
}
