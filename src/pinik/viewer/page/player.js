/** The player of a saved animation, whose frames are in the page itself. */

import { byId } from "pinik/elements.js";
import { addPresets } from "pinik/presets.js";
import { Show } from "pinik/show.js";
import { Theme } from "pinik/theme.js";
import { inflated, pieces, unpackedFrames } from "pinik/unpack.js";

const SAMPLES = 60; // number of frames that the camera is set up for
const TAIL = 90; // number of earlier frames that a trail shows

class Player {
    /** @param recording the recording with its frames and commands unpacked */
    constructor(recording) {
        this._show = new Show({ canvas: byId("canvas"), labels: byId("labels") }, new Theme(), { played: true });
        this._frames = recording.frames;
        this._size = recording.frame_bytes;
        this._count = Math.floor(this._frames.byteLength / Math.max(this._size, 1));
        this._rate = recording.frames_per_second;
        this._at = 0;
        this._shown = -1;
        this._before = null;
        addPresets(byId("presets"), this._show);
        this._show.setHello(recording.hello);
        this._show.setRobot(recording.robot);
        this._show.setState(recording.state);
        for (const command of recording.commands) this._show.command(command);
        this._show.setShapes(recording.shapes);
        this._show.foresee(this._sampled());
        this._bind();
        this._play(this._count > 1);
        this._show.stage.onTick((now) => this._tick(now));
    }

    _bind() {
        byId("time").max = Math.max(0, this._count - 1);
        byId("play").addEventListener("click", () => this._play(!this._playing));
        byId("time").addEventListener("input", ({ target }) => this._seek(Number(target.value)));
        document.addEventListener("keydown", (event) => {
            if (event.key !== " " || event.target.matches("button, select")) return;
            event.preventDefault();
            this._play(!this._playing);
        });
    }

    _play(on) {
        this._playing = on;
        byId("play").ariaLabel = on ? "Pause" : "Play";
        byId("play")
            .querySelector("use")
            .setAttribute("href", on ? "#icon-pause" : "#icon-play");
    }

    /** Go to a frame, and rebuild the trails from the frames before it. */
    _seek(at) {
        this._at = at;
        this._show.cast.clearTrails();
        for (let k = Math.max(0, at - TAIL); k < at; k++) this._show.addToTrails(this._frame(k));
        this._shown = -1;
    }

    _frame(k) {
        return this._frames.slice(k * this._size, (k + 1) * this._size);
    }

    /** Frames from the first to the last one, a few. */
    _sampled() {
        const count = Math.min(this._count, SAMPLES);
        return Array.from({ length: count }, (_, k) =>
            this._frame(Math.round((k * (this._count - 1)) / Math.max(1, count - 1))),
        );
    }

    _tick(now) {
        if (this._playing) {
            // Frame times may go back, and the first tick has none before it.
            const passed = Math.max(0, now - (this._before ?? now));
            this._at += (passed / 1000) * this._rate * Number(byId("rate").value);
            if (this._at >= this._count) {
                this._at = 0;
                this._show.cast.clearTrails();
            }
        }
        this._before = now;
        const k = Math.floor(this._at);
        if (k === this._shown || this._count === 0) return;
        this._shown = k;
        this._show.setFrame(this._frame(k));
        byId("time").value = k;
        byId("clock").textContent =
            `${(k / this._rate).toFixed(1)} s of ${((this._count - 1) / this._rate).toFixed(1)} s`;
    }
}

async function read(recording) {
    const [planes, commands] = await Promise.all([inflated(recording.frames), inflated(recording.commands)]);
    return {
        ...recording,
        frames: unpackedFrames(planes, recording.frame_bytes),
        commands: pieces(commands, recording.command_bytes),
    };
}

window.pinik = { player: new Player(await read(JSON.parse(byId("recording").textContent))) };
