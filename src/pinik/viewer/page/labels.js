/** What hovers below each robot: its method and where it stands, never on top of each other. */

const GAP = 6; // [px]

export class Labels {
    constructor(element) {
        this._element = element;
        this._chips = [];
    }

    /** @param texts for each instance {title, words, good} */
    set(texts) {
        while (this._chips.length < texts.length) this._chips.push(this._make(this._chips.length));
        while (this._chips.length > texts.length) this._chips.pop().chip.remove();
        texts.forEach(({ title, words, good }, i) => {
            const { chip, name, state } = this._chips[i];
            if (name.textContent !== title) name.textContent = title;
            if (state.textContent !== words) state.textContent = words;
            chip.classList.toggle("good", good);
        });
    }

    _make(i) {
        const part = (className) => Object.assign(document.createElement("span"), { className });
        const [name, state] = [part("name"), part("words")];
        const chip = Object.assign(document.createElement("div"), { className: "chip" });
        chip.dataset.testid = `label-${i}`;
        chip.style.setProperty("--own", `var(--instance-${i})`);
        chip.append(name, state);
        this._element.append(chip);
        return { chip, name, state };
    }

    /** @param anchors for each instance {x, y, behind} [px]: the middle of the chip's upper edge */
    place(anchors, width, height) {
        const pitch = narrowest(anchors);
        this._element.style.setProperty("--most", `${Math.max(84, Math.min(230, pitch - GAP, width - 2 * GAP))}px`);
        const placed = [];
        this._chips.forEach(({ chip }, i) => {
            const anchor = anchors[i];
            chip.hidden = !anchor || anchor.behind;
            if (chip.hidden) return;
            const [w, h] = [chip.offsetWidth, chip.offsetHeight];
            const x = Math.min(Math.max(anchor.x - w / 2, GAP), width - w - GAP);
            let y = Math.min(Math.max(anchor.y, GAP), height - h - GAP);
            for (const other of placed) {
                if (Math.abs(other.x - x) < (other.w + w) / 2 + GAP && overlaps(other, y, h)) y = other.y - h - GAP;
            }
            placed.push({ x, y, w, h });
            chip.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
        });
    }
}

function overlaps(other, y, h) {
    return y < other.y + other.h + GAP && other.y < y + h + GAP;
}

/** The smallest distance between neighbours in one row. */
function narrowest(anchors) {
    const row = anchors.filter((anchor) => Math.abs(anchor.y - anchors[0].y) < 60).map((anchor) => anchor.x);
    row.sort((a, b) => a - b);
    const gaps = row.slice(1).map((x, k) => x - row[k]);
    return gaps.length ? Math.min(...gaps) : Infinity;
}
