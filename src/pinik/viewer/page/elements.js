/** Short functions that make and find elements. */

export const byId = (id) => document.getElementById(id);

/** make("button", {className: "x", dataset: {testid: "y"}}, child, "text") */
export function make(tag, properties = {}, ...children) {
    const element = document.createElement(tag);
    const { dataset = {}, aria = {}, ...rest } = properties;
    Object.assign(element, rest);
    Object.assign(element.dataset, dataset);
    for (const [name, value] of Object.entries(aria)) element.setAttribute(`aria-${name}`, value);
    element.append(...children);
    return element;
}

/** Set a text only if it differs, so that selections and screen readers are not disturbed. */
export function say(element, text) {
    if (element.textContent !== text) element.textContent = text;
}

export function icon(name) {
    const [svg, use] = ["svg", "use"].map((tag) => document.createElementNS("http://www.w3.org/2000/svg", tag));
    svg.classList.add("icon");
    use.setAttribute("href", `#icon-${name}`);
    svg.append(use);
    return svg;
}
