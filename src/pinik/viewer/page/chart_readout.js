/** What stands around a chart: its legend with the values at the pointer, and the button that enlarges it. */

import { icon, make, say } from "pinik/elements.js";
import { called } from "pinik/words.js";

export class ChartReadout {
    /** @param words a sample's value with its unit */
    constructor(canvas, theme, words) {
        this._figure = canvas.parentElement;
        this._words = words;
        this._at = null;
        this._entries = [];
        this._legend = make("ul", { className: "legend" });
        this._grow = make("button", { type: "button", className: "quiet grow", dataset: { testid: `grow-${canvas.id}` } }, icon("frame"));
        this._figure.querySelector("figcaption").append(this._legend, this._grow);
        this._grow.addEventListener("click", () => this._turn(!this.grown));
        canvas.addEventListener("click", () => this._turn(!this.grown));
        canvas.addEventListener("pointermove", ({ offsetX }) => {
            this._at = offsetX;
        });
        canvas.addEventListener("pointerleave", () => {
            this._at = null;
        });
        this._figure.addEventListener("keydown", (event) => {
            if (event.key !== "Escape" || !this.grown) return;
            event.stopPropagation();
            this._turn(false);
        });
        this._turn(false);
    }

    get grown() {
        return this._figure.classList.contains("grown");
    }

    _turn(grown) {
        for (const other of document.querySelectorAll(".chart.grown")) if (grown && other !== this._figure) other.querySelector(".grow").click();
        this._figure.classList.toggle("grown", grown);
        this._grow.title = grown ? "Back to its place (Esc)" : "Enlarge this chart";
        this._grow.ariaLabel = this._grow.title;
        this._grow.ariaPressed = String(grown);
        if (grown) this._grow.focus({ preventScroll: true });
    }

    /** Name the series; what tells methods of one name apart shows in an enlarged chart. */
    setNames(instances) {
        const names = instances.map(called).join();
        if (this._names === names) return;
        this._names = names;
        this._entries = instances.map(({ method, distinction }, i) => {
            const value = make("b");
            const own = make("span", { className: "distinction" }, distinction ? `, ${distinction}` : "");
            const entry = make("li", {}, make("span", { className: "dot" }), method, own, value);
            entry.style.setProperty("--own", `var(--instance-${i})`);
            return { entry, value };
        });
        this._legend.replaceChildren(...this._entries.map(({ entry }) => entry));
    }

    /**
     * Say each series' value at the pointer, or its newest one in an enlarged chart.
     * @param seconds turns the pointer's place [px] into a time; returns the time at the pointer, or null
     */
    show(history, seconds) {
        const points = this._at !== null;
        const time = points ? seconds(this._at) : history.now;
        history.series.forEach((samples, i) => {
            const near = points || this.grown ? nearest(samples, time) : null;
            if (this._entries[i]) say(this._entries[i].value, near ? this._words(near) : "");
        });
        return points ? time : null;
    }
}

/** The sample nearest to a time; null if there is none within 1.5 s. */
function nearest(samples, time) {
    let [low, high] = [0, samples.length - 1];
    while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (samples[middle].time < time) low = middle;
        else high = middle;
    }
    const best = [samples[low], samples[high]].filter(Boolean).sort((a, b) => Math.abs(a.time - time) - Math.abs(b.time - time))[0];
    return best && Math.abs(best.time - time) < 1.5 ? best : null;
}
