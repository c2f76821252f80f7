/** A live chart: one line per instance over the last seconds. A click enlarges it; pointing at it says the values. */

import { figure, logarithmicScale } from "pinik/chart_scale.js";
import { ChartReadout } from "pinik/chart_readout.js";

const SMALL = { left: 36, right: 6, top: 6, bottom: 16, font: 10 }; // [px]
const LARGE = { left: 62, right: 18, top: 12, bottom: 30, font: 14 };
const WIDTHS = [6, 4.4, 2.9, 1.2]; // [px] of the four lines: where they coincide, each still shows beside the next

export class Chart {
    /** @param options value(sample) in the chart's unit, words(value) with its unit, decades (the fewest on the axis) */
    constructor(canvas, theme, { value, words, decades }) {
        Object.assign(this, { _canvas: canvas, _theme: theme, _value: value, _decades: decades });
        this._readout = new ChartReadout(canvas, theme, (sample) => words(value(sample)));
    }

    /** Name the instances in the legend. */
    setState({ instances }) {
        this._readout.setNames(instances);
    }

    /** @param mark the value of a dashed line, or null */
    draw(history, mark) {
        const pen = this._begin();
        if (!pen) return;
        const { left, right, top, bottom } = this._margins;
        const area = { left, right: this._width - right, top, bottom: this._height - bottom };
        const values = history.series.flat().map(this._value).filter(Number.isFinite);
        const scale = logarithmicScale(values, mark, this._decades);
        const y = (value) => area.bottom - scale.part(value) * (area.bottom - area.top);
        const x = (time) => area.right - ((history.now - time) / history.seconds) * (area.right - area.left);
        this._axes(pen, area, scale, x, y, history);
        if (mark !== null) this._mark(pen, area, y(mark));
        pen.lineJoin = "round";
        history.series.forEach((samples, i) => {
            pen.lineWidth = WIDTHS[i] * (this._readout.grown ? 1.2 : 0.8);
            pen.strokeStyle = pen.fillStyle = this._theme.color(`instance-${i}`);
            this._line(pen, samples, x, y);
            this._beyond(pen, samples, scale, x, area);
        });
        const seconds = (at) => history.now - ((area.right - at) / (area.right - area.left)) * history.seconds;
        this._pointer(pen, area, this._readout.show(history, seconds), x);
    }

    get _margins() {
        return this._readout.grown ? LARGE : SMALL;
    }

    _begin() {
        const { clientWidth: width, clientHeight: height } = this._canvas;
        if (!width || !height) return null;
        const ratio = devicePixelRatio * (this._canvas.currentCSSZoom ?? 1);
        const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
        if (this._canvas.width !== w || this._canvas.height !== h) Object.assign(this._canvas, { width: w, height: h });
        Object.assign(this, { _width: width, _height: height });
        const pen = this._canvas.getContext("2d");
        pen.setTransform(ratio, 0, 0, ratio, 0, 0);
        pen.clearRect(0, 0, width, height);
        pen.font = `${this._margins.font}px system-ui, sans-serif`;
        return pen;
    }

    _axes(pen, area, { ticks, between }, x, y, history) {
        pen.fillStyle = this._theme.color("soft-ink");
        pen.strokeStyle = this._theme.color("hair");
        pen.lineWidth = 1;
        pen.textAlign = "right";
        pen.textBaseline = "middle";
        if (this._readout.grown) {
            pen.save();
            pen.globalAlpha = 0.45;
            for (const value of between) across(pen, area, y(value));
            pen.restore();
        }
        for (const tick of ticks) {
            across(pen, area, y(tick));
            pen.fillText(figure(tick), area.left - 6, y(tick));
        }
        pen.textAlign = "center";
        pen.textBaseline = "alphabetic";
        for (const back of this._width > 260 ? [8, 6, 4, 2] : [8, 4])
            pen.fillText(`−${back} s`, x(history.now - back), this._height - this._margins.font * 0.4);
    }

    _mark(pen, area, at) {
        pen.save();
        pen.strokeStyle = this._theme.color("good");
        pen.setLineDash([4, 3]);
        across(pen, area, at);
        pen.restore();
    }

    _line(pen, samples, x, y) {
        pen.beginPath();
        let open = false;
        for (const sample of samples) {
            const value = this._value(sample);
            if (!Number.isFinite(value)) open = false;
            else if (open) pen.lineTo(x(sample.time), y(value));
            else {
                pen.moveTo(x(sample.time), y(value));
                open = true;
            }
        }
        pen.stroke();
    }

    /** Small triangles at the upper edge for values beyond it. */
    _beyond(pen, samples, { top }, x, area) {
        for (const sample of samples) {
            if (!(this._value(sample) > top)) continue;
            const at = x(sample.time);
            pen.beginPath();
            pen.moveTo(at - 4, area.top + 6);
            pen.lineTo(at, area.top - 1);
            pen.lineTo(at + 4, area.top + 6);
            pen.fill();
        }
    }

    _pointer(pen, area, time, x) {
        if (time === null) return;
        pen.strokeStyle = this._theme.color("faint");
        pen.lineWidth = 1;
        pen.beginPath();
        pen.moveTo(x(time), area.top);
        pen.lineTo(x(time), area.bottom);
        pen.stroke();
    }
}

function across(pen, area, y) {
    const at = Math.round(y) + 0.5;
    pen.beginPath();
    pen.moveTo(area.left, at);
    pen.lineTo(area.right, at);
    pen.stroke();
}
