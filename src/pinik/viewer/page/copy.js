/** A button that copies a text, and says so. */

import { make } from "pinik/elements.js";

const SAID = 1600; // [ms]

export class Copy {
    /** @param text returns the text to copy */
    constructor(text, testid) {
        this.element = make("button", { type: "button", className: "soft", dataset: { testid } }, "Copy");
        this.element.addEventListener("click", async () => {
            await copied(text());
            this.element.textContent = "Copied";
            setTimeout(() => {
                this.element.textContent = "Copy";
            }, SAID);
        });
    }
}

/** Copy a text; pages that are not served from this machine have no clipboard, so they select and copy. */
async function copied(text) {
    try {
        await navigator.clipboard.writeText(text);
    } catch {
        const area = make("textarea", { value: text });
        document.body.append(area);
        area.select();
        document.execCommand("copy");
        area.remove();
    }
}
