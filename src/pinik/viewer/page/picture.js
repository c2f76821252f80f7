/** The view as a PNG of any size, with the background or without. */

import { byId, say } from "pinik/elements.js";
import { THREE } from "pinik/three.js";

const TILE = 2048; // [px]; larger pictures are drawn in pieces, because graphics cards limit their size
const MOST = 16384; // [px], the widest canvas of common browsers

export class PictureDialog {
    constructor(show, theme) {
        this._show = show;
        this._theme = theme;
        byId("picture-open").addEventListener("click", () => this.open());
        byId("picture-save").addEventListener("click", () => this._save());
        byId("picture-width").addEventListener("input", () => this._tell());
        byId("picture-dialog").addEventListener("click", ({ target }) => {
            if (target === byId("picture-dialog")) byId("picture-dialog").close();
        });
    }

    open() {
        byId("picture-width").max = MOST;
        byId("picture-width").value = Math.min(MOST, 2 * this._show.stage.width);
        this._tell();
        byId("picture-dialog").showModal();
    }

    get _size() {
        const { width, height } = this._show.stage;
        const wanted = Math.round(Math.min(Math.max(Number(byId("picture-width").value) || width, 16), MOST));
        const high = Math.round((wanted * height) / width);
        return high > MOST ? { width: Math.round((MOST * width) / height), height: MOST } : { width: wanted, height: high };
    }

    _tell() {
        const { width, height } = this._size;
        const cut = Number(byId("picture-width").value) > width;
        say(byId("picture-size"), `${width} × ${height} pixels${cut ? ", the largest that is possible" : ""}`);
    }

    async _save() {
        const canvas = paint(this._show, this._theme, this._size, byId("picture-transparent").checked);
        const blob = await new Promise((done) => canvas.toBlob(done, "image/png"));
        byId("picture-dialog").close();
        const link = Object.assign(document.createElement("a"), {
            href: URL.createObjectURL(blob),
            download: `pinik-${this._show.state.robot.replace(/[^\w-]+/g, "_")}.png`,
        });
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    }
}

/** Draw the scene as it is seen now; without the ground where the background is transparent. */
export function paint(show, theme, { width, height }, transparent) {
    const { stage } = show;
    const { viewer, ground } = stage;
    const { renderer, camera } = viewer;
    const canvas = Object.assign(document.createElement("canvas"), { width, height });
    const pen = canvas.getContext("2d");
    if (!transparent) {
        const sky = pen.createLinearGradient(0, 0, 0, height);
        sky.addColorStop(0, theme.color("sky-top"));
        sky.addColorStop(1, theme.color("sky-bottom"));
        pen.fillStyle = sky;
        pen.fillRect(0, 0, width, height);
    }
    const before = { ratio: renderer.getPixelRatio(), size: renderer.getSize(new THREE.Vector2()), fine: stage.fine };
    ground.group.visible = !transparent;
    stage.refine(true);
    renderer.setPixelRatio(1);
    renderer.shadowMap.needsUpdate = true;
    for (let left = 0; left < width; left += TILE) {
        for (let top = 0; top < height; top += TILE) {
            const [wide, high] = [Math.min(TILE, width - left), Math.min(TILE, height - top)];
            renderer.setSize(wide, high, false);
            camera.setViewOffset(width, height, left, top, wide, high);
            viewer.render();
            pen.drawImage(renderer.domElement, left, top);
        }
    }
    camera.clearViewOffset();
    ground.group.visible = true;
    stage.refine(before.fine);
    renderer.setPixelRatio(before.ratio);
    renderer.setSize(before.size.x, before.size.y);
    stage.touch();
    return canvas;
}
