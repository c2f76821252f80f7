/** What can be taken hold of in the picture: the balls, the rings around one of them, and obstacles. */

import { Grab } from "pinik/grab.js";
import { Nudge } from "pinik/nudge.js";
import { Obstacles } from "pinik/obstacles.js";
import { Rings } from "pinik/rings.js";
import { THREE } from "pinik/three.js";

export class Handles {
    /** @param page the page: connection, ringAxes, show, targets */
    constructor({ connection, ringAxes, show, targets }) {
        this._connection = connection;
        this._targets = targets;
        // Before the balls, so that a ring beside a ball is taken first.
        this.rings = new Rings(show, {
            selected: () => targets.selected,
            local: () => ringAxes.choice === "local",
            onTurn: (index, rpy) => {
                connection.sendNewest(`turn ${index}`, { type: "orientation", index, on: true, rpy });
                targets.turned(index, rpy);
            },
            onDrop: (index) => connection.flush(`turn ${index}`),
        });
        this._balls = new Grab(show, {
            onGrab: (k) => targets.select(k),
            onMove: (k, position) => this._moveBall(k, position),
            onDrop: (k) => connection.flush(`ball ${k}`),
            onHover: (k) => show.pointAt(k),
        });
        this._obstacles = new Obstacles(show);
        const nothing = () => {};
        const hands = {
            onGrab: nothing,
            onMove: (index, position) =>
                connection.sendNewest(`obstacle ${index}`, { type: "obstacle", index, position }),
            onDrop: (index) => connection.flush(`obstacle ${index}`),
            onHover: nothing,
        };
        this._obstacleGrab = new Grab(this._obstacles, hands, "over-obstacle");
        this.nudge = new Nudge(show, (k, position) => {
            show.balls.hold(k, new THREE.Vector3(...position));
            show.letGoOfBall(k);
            this._moveBall(k, position);
        });
    }

    setState(state) {
        this._obstacles.setState(state);
    }

    _moveBall(index, position) {
        this._connection.sendNewest(`ball ${index}`, { type: "ball", index, position });
        this._targets.moved(index, position);
    }
}
