/** The labels below the robots: method and result. They never overlap. */

import { make, say } from "pinik/elements.js";

const GAP = 6; // [px]
const NARROW = 165; // [px] a label with less room than this shows the method's short name

export class Labels {
    constructor(element) {
        this._element = element;
        this._chips = [];
    }

    /** @param texts {title, method, words, tone} of each instance */
    set(texts) {
        while (this._chips.length < texts.length) this._chips.push(this._make(this._chips.length));
        while (this._chips.length > texts.length) this._chips.pop().chip.remove();
        texts.forEach(({ title, method, words, tone }, i) => {
            const { chip, name, state } = this._chips[i];
            say(name, this._narrow ? method : title);
            say(state, words);
            state.dataset.tone = tone;
        });
    }

    _make(i) {
        const [name, state] = ["name", "words"].map((className) => make("span", { className }));
        const chip = make("div", { className: "chip", dataset: { testid: `label-${i}` } }, name, state);
        chip.style.setProperty("--own", `var(--instance-${i})`);
        this._element.append(chip);
        return { chip, name, state };
    }

    /** @param anchors {x, y, behind} [px] of each instance: the middle of the label's upper edge */
    place(anchors, width, height) {
        const room = Math.max(84, Math.min(230, narrowest(anchors) - GAP, width - 2 * GAP));
        this._narrow = room < NARROW;
        this._element.classList.toggle("narrow", this._narrow);
        this._element.style.setProperty("--most", `${room}px`);
        const placed = [];
        this._chips.forEach(({ chip }, i) => {
            const anchor = anchors[i];
            chip.hidden = !anchor || anchor.behind;
            if (chip.hidden) return;
            const [w, h] = [chip.offsetWidth, chip.offsetHeight];
            const fits = (left) => Math.min(Math.max(left, GAP), width - w - GAP);
            let x = fits(anchor.x - w / 2);
            let y = Math.min(Math.max(anchor.y, GAP), height - h - GAP);
            for (const other of placed) {
                if (overlap(other, { x, y, w, h })) x = fits(other.x + other.w + GAP);
                if (overlap(other, { x, y, w, h })) y = other.y - h - GAP;
            }
            placed.push({ x, y, w, h });
            chip.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
        });
    }
}

function overlap(a, b) {
    return a.x < b.x + b.w + GAP && b.x < a.x + a.w + GAP && a.y < b.y + b.h + GAP && b.y < a.y + a.h + GAP;
}

/** The smallest distance between neighbours in the first row. */
function narrowest(anchors) {
    const row = anchors.filter((anchor) => Math.abs(anchor.y - anchors[0].y) < 60).map((anchor) => anchor.x);
    row.sort((a, b) => a - b);
    const gaps = row.slice(1).map((x, k) => x - row[k]);
    return gaps.length ? Math.min(...gaps) : Infinity;
}
