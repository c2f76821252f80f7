/** The names of a robot's links, written where there is room. */

import { make, say } from "pinik/elements.js";
import { THREE } from "pinik/three.js";

const ROOM = { w: 6.2, h: 15 }; // [px] per letter, and per line

export class Names {
    /** @param show the scene */
    constructor(labels, show) {
        this._show = show;
        this._spans = [];
        this._element = make("div", { className: "names", aria: { hidden: "true" } });
        labels.before(this._element);
    }

    place(on) {
        const shown = on ? this._shown() : [];
        while (this._spans.length < shown.length) {
            this._spans.push(make("span"));
            this._element.append(this._spans.at(-1));
        }
        while (this._spans.length > shown.length) this._spans.pop().remove();
        shown.forEach(({ name, x, y }, k) => {
            say(this._spans[k], name);
            this._spans[k].style.transform = `translate(${x.toFixed(0)}px, ${y.toFixed(0)}px)`;
        });
    }

    /** The names that do not overlap others, the ends of chains first. */
    _shown() {
        const { cast, robot, stage } = this._show;
        const rank = new Map(robot.frames.map((name, k) => [name, k]));
        const links = [...robot.links].sort((a, b) => (rank.get(a.name) ?? 1e6) - (rank.get(b.name) ?? 1e6));
        const shown = [];
        cast.instances.forEach((instance, i) => {
            for (const { name, joint, placement } of links) {
                const at = new THREE.Vector3().fromArray(placement);
                const { position, quaternion } = instance.robot.joints[joint];
                at.applyQuaternion(quaternion).add(position).add(cast.offset(i));
                const { x, y, behind } = stage.project(at);
                const mine = { name, x: x + 6, y: y - 6, w: ROOM.w * name.length };
                const hits = (other) =>
                    Math.abs(other.y - mine.y) < ROOM.h && mine.x < other.x + other.w && other.x < mine.x + mine.w;
                if (!behind && !shown.some(hits)) shown.push(mine);
            }
        });
        return shown;
    }
}
