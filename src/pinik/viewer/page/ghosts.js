/** Translucent copies of the robot: the other answers around the first instance. */

import { Robot } from "pinik/robot.js";

const OPACITY = 0.16;
const TOGETHER = 0.9; // the most that the opacities of all ghosts add up to
const CHOSEN = 0.55;

export class Ghosts {
    /** @param show the scene */
    constructor(show) {
        this._show = show;
        this._ghosts = [];
        this._opacity = OPACITY;
    }

    /** @param placements for each ghost the placements of all joints, in one array of numbers */
    set(placements, instance = 0) {
        this.clear();
        const parent = this._show.cast.instances[instance];
        if (!parent) return;
        const { robot } = this._show;
        const still = new Float32Array(robot.joints.length);
        this._opacity = Math.min(OPACITY, TOGETHER / placements.length);
        this._ghosts = placements.map((numbers) => {
            const ghost = new Robot(robot, this._show.cast.parts, "#8d98a5");
            ghost.update({ placements: () => numbers, sides: () => still }, 0, new Set());
            ghost.fade(this._opacity);
            parent.group.add(ghost.group);
            return ghost;
        });
        this._show.showAlso(this._ghosts.flatMap((ghost) => ghost.corners()));
    }

    /** Show one ghost more strongly, or none if `index` is null. */
    choose(index) {
        this._ghosts.forEach((ghost, k) => ghost.fade(k === index ? CHOSEN : this._opacity));
        this._show.stage.touch();
    }

    clear() {
        for (const ghost of this._ghosts) ghost.dispose();
        this._ghosts = [];
        this._show.showAlso([]);
    }
}
