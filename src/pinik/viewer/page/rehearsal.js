/** What most pictures show, too small to be seen: drawing it once compiles its shaders while the robots are awaited. */

import { Ball } from "pinik/ball.js";
import { Ribbon } from "pinik/ribbon.js";
import { Robot } from "pinik/robot.js";
import { THREE } from "pinik/three.js";

const CUBE = { joints: [{}], links: [{ joint: 0, placement: [0, 0, 0, 0, 0, 0, 1], name: "" }], size: 1 };

export function rehearse(stage) {
    const ball = new Ball(1);
    ball.show({ mode: "on", oriented: false, free: [] }, true, false);
    const material = new THREE.MeshPhongMaterial();
    const robot = new Robot(CUBE, [{ link: 0, geometry: new THREE.BoxGeometry(), material }], "#000");
    robot.refine(stage.fine);
    const ribbon = new Ribbon({ capacity: 2, width: 1, opacity: 0 });
    ribbon.set([0, 0, 0, 1, 1, 1], 2);
    const all = new THREE.Group().add(ball.group, robot.group, ribbon.mesh);
    all.scale.setScalar(1e-9);
    stage.scene.add(all);
    stage.draw();
    stage.scene.remove(all);
    // Nothing is disposed of, because a shader goes with the last material that uses it.
}
