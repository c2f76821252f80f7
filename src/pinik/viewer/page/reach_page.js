/** The saved page of a map of what a robot can reach, whose numbers are in the page itself. */

import { Camera, PRESETS } from "pinik/camera.js";
import { Cells } from "pinik/cells.js";
import { byId, make, say } from "pinik/elements.js";
import { addPresets } from "pinik/presets.js";
import { Stage } from "pinik/stage.js";
import { Theme } from "pinik/theme.js";
import { THREE } from "pinik/three.js";
import { inflated } from "pinik/unpack.js";

const AXES = ["x", "y", "z"];
const BEYOND = 0.06; // a cut begins so far past the middle, as a share of the width, so that the robot stands clear

class ReachPage {
    constructor(map, parts) {
        this._map = map;
        this._theme = new Theme();
        this.stage = new Stage(byId("canvas"), this._theme);
        this.camera = new Camera(this.stage);
        this.camera.caption = { w: 0, h: 0 };
        this._cells = new Cells(map);
        this._cells.group.applyMatrix4(new THREE.Matrix4().set(...map.placement.flat()));
        this._robot = robotOf(parts);
        this.stage.scene.add(this._cells.group, this._robot);
        this._cuts = map.shape.map(() => null);
        this._own = map.shape.map(() => false); // the cuts that somebody has moved
        this._mirror = [];
        this._points = this._corners();
        this._fill();
        this._bind();
        addPresets(byId("presets"), this);
        this.stage.onResize = () => this.camera.moved || this.frameAll(false);
        this.stage.onTick(() => this._face());
        this.frameAll(false);
        this._draw();
    }

    /** Look at everything. */
    frameAll(smoothly, preset = this.camera.preset) {
        this.camera.frame(this._points, 1, preset, smoothly);
    }

    /** Lay the ground, and return the outermost points of the robot and the cells. */
    _corners() {
        const robot = new THREE.Box3().setFromObject(this._robot);
        const { matrix } = this._cells.group;
        const centers = Array.from(this._map.cells, (_, row) => this._cells.center(row).applyMatrix4(matrix));
        const { min, max } = robot.clone().union(new THREE.Box3().setFromPoints(centers));
        const size = max.distanceTo(min);
        this.stage.ground.lay(min.z, (min.x + max.x) / 2, (min.y + max.y) / 2, size, size / 2);
        this.stage.ground.group.visible = false;
        return outermost([...centers, ...corners(robot)], this._map.size);
    }

    _fill() {
        const map = this._map;
        say(byId("name"), map.title);
        say(byId("summary"), map.summary);
        for (const [name, { title }] of Object.entries(map.quantities)) {
            byId("quantity").append(make("option", { value: name }, title));
        }
        byId("bar").style.background = `linear-gradient(90deg, ${map.colors.join(", ")})`;
        byId("down-field").hidden = !map.down;
        byId("least").max = map.quantities.share.largest;
        const { azimuth } = PRESETS[this.camera.preset];
        this._faced = [Math.cos(azimuth), Math.sin(azimuth), 1].map(Math.sign);
        const places = map.shape.map((count, axis) => {
            const place = Math.floor(count / 2) - this._faced[axis] * Math.ceil(BEYOND * count);
            return Math.min(Math.max(place, 0), count - 1);
        });
        AXES.forEach((name, axis) => {
            const [on, slider, value] = [
                make("input", { type: "checkbox", dataset: { testid: `cut-${name}` } }),
                make("input", { type: "range", min: 0, max: map.shape[axis] - 1, step: 1, value: places[axis] }),
                make("output"),
            ];
            slider.dataset.testid = `at-${name}`;
            slider.ariaLabel = `Cut across ${name}`;
            on.checked = axis < 2 && map.shape[axis] > 1 && map.shape[2] > 1;
            const change = () => {
                const k = Number(slider.value);
                this._cuts[axis] = on.checked ? k : null;
                say(value, `${(map.origin[axis] + k * map.size).toFixed(3)} m`);
            };
            change();
            on.addEventListener("change", () => [change(), this._draw()]);
            slider.addEventListener("input", () => [(on.checked = true), (this._own[axis] = true), change(), this._draw()]);
            this._mirror[axis] = () => [(slider.value = map.shape[axis] - 1 - Number(slider.value)), change()];
            byId("cuts").append(make("div", { className: "cut" }, make("label", { className: "check" }, on, name), slider, value));
        });
    }

    _bind() {
        for (const id of ["quantity", "least", "down", "layers"]) byId(id).addEventListener("input", () => this._draw());
        byId("robot").addEventListener("change", ({ target }) => this._toggle(this._robot, target.checked));
        byId("floor").addEventListener("change", ({ target }) => this._toggle(this.stage.ground.group, target.checked));
        byId("theme").addEventListener("click", () => this._theme.turn());
        this.stage.canvas.addEventListener("pointermove", (event) => this._read(event));
    }

    _toggle(object, shown) {
        object.visible = shown;
        this.stage.recast();
    }

    /** On which side of each cut the camera is: there, cells are removed. */
    _sides() {
        const { camera, controls, scene } = this.stage.viewer;
        const turn = new THREE.Matrix4().copy(scene.matrixWorld).multiply(this._cells.group.matrix).invert();
        const [from, to] = [camera.position.clone().applyMatrix4(turn), controls.target.clone().applyMatrix4(turn)];
        return from.sub(to).toArray().map((part) => (part < 0 ? -1 : 1));
    }

    /** Cut the map open anew once the camera has gone round to another side. */
    _face() {
        const sides = this._sides();
        const turned = sides.map((side, axis) => side !== this._faced[axis]);
        if (!turned.some(Boolean)) return;
        this._faced = sides;
        turned.forEach((gone, axis) => gone && !this._own[axis] && this._mirror[axis]());
        this._draw();
    }

    _draw() {
        const map = this._map;
        const { values, largest } = map.quantities[byId("quantity").value];
        const [least, down] = [Number(byId("least").value), byId("down").checked];
        const share = map.quantities.share.values;
        this._cells.draw({
            passes: (row) => share[row] >= least && (!down || map.down[row] > 0),
            cuts: this._cuts,
            sides: this._faced,
            layers: byId("layers").checked,
            color: (row) => mixed(map.rgb, values[row] / largest),
        });
        say(byId("largest"), largest.toPrecision(3));
        say(byId("least-value"), `${Number((100 * least).toPrecision(2))} %`);
        say(byId("count"), `${this._cells.count.toLocaleString("en")} · ${(this._cells.count * map.size ** 3).toPrecision(3)} m³`);
        this.stage.touch();
    }

    _read({ offsetX, offsetY }) {
        const at = new THREE.Vector2((2 * offsetX) / this.stage.width - 1, 1 - (2 * offsetY) / this.stage.height);
        const caster = new THREE.Raycaster();
        caster.setFromCamera(at, this.stage.viewer.camera);
        const row = this._cells.under(caster);
        const lines = [];
        if (row !== null) {
            const center = this._cells.center(row).toArray();
            lines.push(["centre", `${center.map((part) => part.toFixed(2)).join(", ")} m`]);
            for (const { title, values } of Object.values(this._map.quantities)) {
                lines.push([title, values[row].toPrecision(3)]);
            }
        }
        byId("readout").replaceChildren(...lines.flatMap(([name, text]) => [make("dt", {}, name), make("dd", {}, text)]));
    }
}

function corners({ min, max }) {
    return [0, 1, 2, 3, 4, 5, 6, 7].map(
        (k) => new THREE.Vector3(k & 1 ? max.x : min.x, k & 2 ? max.y : min.y, k & 4 ? max.z : min.z),
    );
}

/** Of many points those that are outermost in some direction, moved out by a margin. */
function outermost(points, margin) {
    const parts = [-1, -0.5, 0, 0.5, 1];
    const ways = parts.flatMap((x) => parts.flatMap((y) => parts.map((z) => new THREE.Vector3(x, y, z))));
    return ways
        .filter((way) => way.lengthSq())
        .map((way) => {
            const first = points.reduce((best, point) => (point.dot(way) > best.dot(way) ? point : best));
            return first.clone().addScaledVector(way, margin);
        });
}

/** The robot's parts as meshes in the world. */
function robotOf(parts) {
    const group = new THREE.Group();
    for (const { color, opacity, position, normal, index } of parts) {
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
        geometry.setAttribute("normal", new THREE.BufferAttribute(normal, 3, true));
        geometry.setIndex(new THREE.BufferAttribute(index, 1));
        const material = new THREE.MeshStandardMaterial({
            color: new THREE.Color(...color.map((part) => Math.min(part, 0.9))).convertSRGBToLinear(),
            roughness: 0.55,
            metalness: 0.05,
            side: THREE.DoubleSide,
            transparent: opacity < 1,
            opacity,
        });
        const mesh = new THREE.Mesh(geometry, material);
        mesh.castShadow = true;
        group.add(mesh);
    }
    return group;
}

/** The colour of a number in 0..1. */
function mixed(colors, value) {
    const at = Math.min(Math.max(value || 0, 0), 1) * (colors.length - 1);
    const k = Math.min(Math.floor(at), colors.length - 2);
    return colors[k].map((part, channel) => part + (colors[k + 1][channel] - part) * (at - k));
}

async function read(document) {
    const floats = async (text) => new Float32Array((await inflated(text)).buffer);
    const map = { ...document, cells: new Int32Array((await inflated(document.cells)).buffer) };
    map.quantities = {};
    for (const [name, own] of Object.entries(document.quantities)) {
        map.quantities[name] = { ...own, values: await floats(own.values) };
    }
    map.down = document.down && (await inflated(document.down));
    map.rgb = document.colors.map((text) => [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16) / 255));
    const { buffer } = await inflated(document.robot.bytes);
    const parts = document.robot.parts.map(({ color, opacity, low, step, vertices, faces, start }) => {
        const packed = new Uint16Array(buffer, start.position, 3 * vertices);
        return {
            color,
            opacity,
            position: Float32Array.from(packed, (part, k) => low[k % 3] + part * step[k % 3]),
            normal: new Int8Array(buffer, start.normal, 3 * vertices),
            index: new Uint32Array(buffer, start.index, 3 * faces),
        };
    });
    return [map, parts];
}

window.pinik = { reach: new ReachPage(...(await read(JSON.parse(byId("map").textContent)))) };
