/** The canvas: meshcat's viewer with pinik's own lights, ground and drawing loop. */

import { Ground } from "pinik/ground.js";
import { Lights } from "pinik/lights.js";
import { Quality } from "pinik/quality.js";
import { THREE, Viewer } from "pinik/three.js";

const FIELD_OF_VIEW = 20; // [deg], narrow, so that instances side by side have the same size
const SETTLE = 400; // [ms] without a change after which the picture is drawn in full detail
const IDLE = 20; // animation frames that must pass too, so that a slow picture does not count as a still one

export class Stage {
    constructor(element, theme) {
        this.element = element;
        this.theme = theme;
        this.frames = 0;
        this._tickers = [];
        this._last = 0;
        this._idle = 0;
        this._settled = false;
        /** Whether nothing is to be drawn yet. */
        this.held = false;
        const { renderer, software } = makeRenderer();
        this._quality = new Quality(software);
        this._setUpViewer(renderer);
        this.ground = new Ground();
        this.lights = new Lights(software);
        this.viewer.scene.add(this.ground.group, this.lights.group);
        this.viewer.scene.updateMatrixWorld();
        this.refine(this._quality.now.fine);
        this._paint();
        theme.addEventListener("change", () => this._paint());
        new ResizeObserver(() => this._resize()).observe(element);
        requestAnimationFrame((now) => this._tick(now));
    }

    _setUpViewer(renderer) {
        renderer.outputEncoding = THREE.sRGBEncoding;
        renderer.shadowMap.enabled = true;
        renderer.shadowMap.autoUpdate = false;
        renderer.debug.checkShaderErrors = false; // asking waits for the compiler, shader by shader
        this.element.append(renderer.domElement);
        const viewer = new Viewer(this.element, false, renderer);
        viewer.gui.domElement.remove();
        for (const name of ["Lights", "Grid", "Axes"]) viewer.delete_path([name]);
        viewer.set_property(["Background"], "visible", false);
        // meshcat would take its size from the window; here the layout decides.
        viewer.set_3d_pane_size = () => this._resize();
        // The only command of meshcat that evaluates text as code; nothing here needs it.
        viewer.set_control = () => {};
        viewer.camera.fov = FIELD_OF_VIEW;
        viewer.controls.zoomSpeed = 0.8;
        this.viewer = viewer;
    }

    /** Whether the picture has stopped changing and has been drawn in full detail. */
    get settled() {
        return this._settled && !this.viewer.needs_render;
    }

    get canvas() {
        return this.viewer.renderer.domElement;
    }

    get width() {
        return this.element.clientWidth;
    }

    get height() {
        return this.element.clientHeight;
    }

    /** The scene of the robots' world; z is up. */
    get scene() {
        return this.viewer.scene;
    }

    /** Call a function with the time [ms] at every animation frame. */
    onTick(ticker) {
        this._tickers.push(ticker);
    }

    /** Draw again, because something changed. */
    touch() {
        this.viewer.set_dirty();
    }

    /** Draw the shadows again in the next picture, because what casts them has changed. */
    recast() {
        this._recast = true;
        this.touch();
    }

    _paint() {
        this.ground.paint(this.theme);
        this.lights.paint(this.theme);
        this.touch();
    }

    _resize() {
        if (this.width === 0 || this.height === 0) return;
        this._ratio = null;
        this.viewer.camera.aspect = this.width / this.height;
        this.touch();
        this.onResize?.();
    }

    _tick(now) {
        requestAnimationFrame((next) => this._tick(next));
        for (const ticker of this._tickers) ticker(now);
        if (this.held) return;
        if (this.viewer.needs_render) {
            if (!this._settled) this._quality.note(now - this._last);
            this._settled = false;
            this._last = now;
            this._idle = 0;
            const level = this._quality.now;
            this._render(level, this._recast || this.frames % level.shadowEvery === 0);
            this._recast = false;
            return;
        }
        this._idle += 1;
        if (!this._settled && this._idle > IDLE && now - this._last > SETTLE) {
            this._settled = true;
            this._render(this._quality.still, true);
        }
    }

    _render({ ratio, fine }, shadows) {
        const { camera, controls, renderer } = this.viewer;
        if (this._ratio !== ratio) {
            this._ratio = ratio;
            renderer.setPixelRatio(ratio);
            renderer.setSize(this.width, this.height);
        }
        this.refine(fine);
        // Each kind of material is drawn at one level of detail only, so each keeps its own kind of shadow.
        renderer.shadowMap.type = fine ? THREE.PCFSoftShadowMap : THREE.BasicShadowMap;
        renderer.shadowMap.needsUpdate = shadows;
        const distance = camera.position.distanceTo(controls.target);
        camera.near = distance / 25;
        camera.far = distance * 30;
        this.viewer.render();
        this.frames += 1;
        this.onDrawn?.();
    }

    /** Draw in detail, or quickly. */
    refine(fine) {
        if (this.fine === fine) return;
        this.fine = fine;
        this.ground.refine(fine);
        this.onRefine?.(fine);
    }

    /** The size of a pixel at what the camera looks at [m]. */
    get pixel() {
        const { camera, controls } = this.viewer;
        const distance = camera.position.distanceTo(controls.target);
        return (2 * distance * Math.tan((camera.fov * Math.PI) / 360)) / this.height;
    }

    /** Where a pointer event is on the canvas [CSS px]. */
    pointer({ clientX, clientY }) {
        const { left, top } = this.element.getBoundingClientRect();
        return { x: clientX - left, y: clientY - top };
    }

    /** The ray through a point of the canvas [CSS px], in the scene (z up). */
    ray({ x, y }) {
        const { camera, scene } = this.viewer;
        const caster = new THREE.Raycaster();
        caster.setFromCamera(new THREE.Vector2((2 * x) / this.width - 1, 1 - (2 * y) / this.height), camera);
        return caster.ray.applyMatrix4(scene.matrixWorld.clone().invert());
    }

    /** The position of a point of the scene (z up) on the canvas [CSS px]; `behind` if it is behind the camera. */
    project(point) {
        const { camera, scene } = this.viewer;
        camera.updateWorldMatrix(true, false);
        const seen = point.clone().applyMatrix4(scene.matrixWorld).project(camera);
        return { x: ((seen.x + 1) / 2) * this.width, y: ((1 - seen.y) / 2) * this.height, behind: seen.z > 1 };
    }
}

/** A renderer, and whether it runs on the processor, where antialiasing costs too much. */
function makeRenderer() {
    const renderer = new THREE.WebGLRenderer({ alpha: true });
    if (isSoftware(renderer.getContext())) return { renderer, software: true };
    renderer.forceContextLoss();
    renderer.dispose();
    return { renderer: new THREE.WebGLRenderer({ antialias: true, alpha: true }), software: false };
}

function isSoftware(gl) {
    const about = gl.getExtension("WEBGL_debug_renderer_info");
    const name = about ? gl.getParameter(about.UNMASKED_RENDERER_WEBGL) : "";
    return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
