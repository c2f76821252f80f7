/** The captions of the robots: method and result. They never overlap each other, and cover as little as they can. */

import { beside as bestPlace, EDGE, shared } from "pinik/beside.js";
import { make, say } from "pinik/elements.js";

const GAP = 6; // [px]
const NARROW = 140; // [px] a label with less room than this shows the method's short name
const BESIDE = 165; // [px] the room that a label gets beside a robot
const SMALL = 620; // [px] and so it does in a picture that is less wide than this
const WIDEST = 230; // [px]
const [HEIGHT, NARROW_HEIGHT] = [44, 34]; // [px]
const LEAST = 84; // [px]
const WEIGHTS = { caption: 1000, ball: 20 }; // of covering other captions and balls, compared with robots

export class Labels {
    constructor(element) {
        this._element = element;
        this._chips = [];
        this._ways = [];
        this._texts = [];
        this.measure();
    }

    /** Read how large the captions are, which depends on the size of the page. */
    measure() {
        this.scale = Number(getComputedStyle(this._element).getPropertyValue("--caption-scale")) || 1;
        const beside = this._element.clientWidth < SMALL ? LEAST : BESIDE;
        const least = (this._narrow ? NARROW_HEIGHT : HEIGHT) * this.scale;
        const tallest = Math.max(least, ...this._chips.map(({ chip }) => chip.offsetHeight));
        /** The width that captions beside robots may have, and the height of the tallest caption [px]. */
        this.size = { w: beside * this.scale, h: tallest };
    }

    /** @param texts {title, name, words, note, tone} of each instance; the name is short */
    set(texts) {
        while (this._chips.length < texts.length) this._chips.push(this._make(this._chips.length));
        while (this._chips.length > texts.length) this._chips.pop().chip.remove();
        this._texts = texts;
        this._write();
    }

    _write() {
        this._texts.forEach(({ title, name: short, words, note, tone }, i) => {
            const { name, state, extra } = this._chips[i];
            say(name, this._narrow ? short : title);
            say(state, words);
            say(extra, note);
            state.dataset.tone = tone;
        });
    }

    _make(i) {
        const [name, state, extra] = ["name", "words", "note"].map((className) => make("span", { className }));
        const chip = make("div", { className: "chip", dataset: { testid: `label-${i}` } }, name, state, extra);
        chip.style.setProperty("--own", `var(--instance-${i})`);
        this._element.append(chip);
        return { chip, name, state, extra };
    }

    /**
     * @param spots {box, foot, behind} of each robot, as for `beside`
     * @param balls rectangles around all balls
     * @param room {width, height} of the picture
     * @param taken rectangles of what else stands in the picture
     * @param beside whether there is room beside the robots, and not below them
     */
    place(spots, balls, room, taken, beside) {
        this._fit(beside ? this.size.w + GAP : narrowest(spots.map(({ foot }) => foot), room), room);
        const covers = [
            ...spots.map(({ box }) => ({ ...box, weight: 1 })),
            ...balls.map((ball) => ({ ...ball, weight: WEIGHTS.ball })),
            ...taken.map((part) => ({ ...part, weight: WEIGHTS.caption })),
        ];
        const placed = [];
        this._each(spots, (spot, chip, i) => {
            const place = bestPlace(spot, sizeOf(chip), covers, room, this._ways[i]);
            this._ways[i] = place.way;
            placed.push(apart(place, placed, room));
            covers.push({ ...placed.at(-1), weight: WEIGHTS.caption });
            move(chip, placed.at(-1));
        });
    }

    /** Stack the captions in the lower left corner, as the legend of robots in one place. */
    stack(spots, room) {
        this._fit(Infinity, room);
        let bottom = room.height - 2 * GAP;
        for (const { chip } of [...this._chips].reverse()) {
            chip.hidden = !spots.length;
            bottom -= chip.offsetHeight + GAP;
            move(chip, { x: 2 * GAP, y: bottom });
        }
    }

    _fit(space, { width }) {
        const most = Math.max(
            LEAST * this.scale,
            Math.min(WIDEST * this.scale, space - GAP, width - 2 * GAP),
        );
        const narrow = most < NARROW * this.scale || width < SMALL * this.scale;
        if (narrow !== this._narrow) {
            this._narrow = narrow;
            this._write();
        }
        this._element.classList.toggle("narrow", this._narrow);
        this._element.style.setProperty("--most", `${most}px`);
    }

    _each(spots, act) {
        this._chips.forEach(({ chip }, i) => {
            chip.hidden = !spots[i] || spots[i].behind;
            if (!chip.hidden) act(spots[i], chip, i);
        });
    }
}

function sizeOf({ offsetWidth: w, offsetHeight: h }) {
    return { w, h };
}

function move(chip, { x, y }) {
    chip.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
}

/** The place moved aside, or up, until it overlaps none of the others. */
function apart(place, others, { width }) {
    const moved = { ...place };
    const hits = (other) => shared({ ...moved, w: moved.w + GAP, h: moved.h + GAP }, { ...other, w: other.w + GAP, h: other.h + GAP }) > 0;
    for (const other of others) {
        if (hits(other)) moved.x = Math.min(Math.max(other.x + other.w + GAP, GAP), width - moved.w - GAP);
        if (hits(other)) moved.y = other.y - moved.h - GAP;
    }
    return moved;
}

/** The room below each robot of the first row: captions there are alike in width, and those at the sides stay inside. */
function narrowest(feet, { width }) {
    const row = feet.filter((foot) => Math.abs(foot.y - feet[0].y) < 60).map((foot) => foot.x);
    row.sort((a, b) => a - b);
    const gaps = row.slice(1).map((x, k) => x - row[k]);
    if (!gaps.length) return Infinity;
    // A caption that the side of the picture moves inwards reaches up to that of its neighbour.
    const inner = [row[1], width - row.at(-2)].map((x) => (2 * (x - EDGE)) / 3);
    const outer = [row[0], width - row.at(-1)];
    const moved = inner.filter((room, k) => room > 2 * (outer[k] - EDGE));
    return Math.min(...gaps, ...moved);
}
