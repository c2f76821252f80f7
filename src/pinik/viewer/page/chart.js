/** A small live chart: one line per instance over the last seconds. */

const LEFT = 34; // [px] for the labels of the axis
const RIGHT = 6;
const TOP = 6;
const BOTTOM = 16;

export class Chart {
    /** @param options value(sample) in the chart's unit, logarithmic, least (the axis ends at this value or above) */
    constructor(canvas, theme, { value, logarithmic, least }) {
        Object.assign(this, {
            _canvas: canvas,
            _theme: theme,
            _value: value,
            _logarithmic: logarithmic,
            _least: least,
        });
        this._range = null;
    }

    /** @param mark the value of a dashed line, or null */
    draw(history, mark) {
        const pen = this._begin();
        if (!pen) return;
        const area = { left: LEFT, right: this._width - RIGHT, top: TOP, bottom: this._height - BOTTOM };
        const scale = this._scale(history.series, mark);
        const y = (value) => area.bottom - scale.part(value) * (area.bottom - area.top);
        const x = (time) => area.right - ((history.now - time) / history.seconds) * (area.right - area.left);
        this._axes(pen, area, scale.ticks, x, y, history);
        if (mark !== null) this._mark(pen, area, y(mark));
        pen.lineWidth = 1.6;
        pen.lineJoin = "round";
        history.series.forEach((samples, i) => {
            pen.strokeStyle = this._theme.color(`instance-${i}`);
            this._line(pen, samples, x, y);
        });
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
        pen.font = "10px system-ui, sans-serif";
        return pen;
    }

    _scale(series, mark) {
        const values = series
            .flat()
            .map(this._value)
            .filter((value) => Number.isFinite(value));
        return this._logarithmic ? logarithmicScale(values, mark) : linearScale(values, this._least);
    }

    _axes(pen, area, ticks, x, y, history) {
        pen.fillStyle = this._theme.color("faint");
        pen.strokeStyle = this._theme.color("hair");
        pen.lineWidth = 1;
        pen.textAlign = "right";
        pen.textBaseline = "middle";
        for (const tick of ticks) {
            const at = Math.round(y(tick)) + 0.5;
            stroke(pen, [
                [area.left, at],
                [area.right, at],
            ]);
            pen.fillText(figure(tick), area.left - 5, at);
        }
        pen.textAlign = "center";
        pen.textBaseline = "alphabetic";
        for (const back of this._width > 260 ? [8, 6, 4, 2] : [8, 4])
            pen.fillText(`−${back} s`, x(history.now - back), this._height - 3);
    }

    _mark(pen, area, at) {
        pen.save();
        pen.strokeStyle = this._theme.color("good");
        pen.setLineDash([4, 3]);
        stroke(pen, [
            [area.left, at],
            [area.right, at],
        ]);
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
}

function stroke(pen, points) {
    pen.beginPath();
    points.forEach(([x, y], k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
    pen.stroke();
}

function figure(tick) {
    if (tick >= 1000) return `${tick / 1000}k`;
    if (tick >= 0.001 || tick === 0) return String(Number(tick.toPrecision(2)));
    return tick.toExponential(0).replace("e-", "e−");
}

/** Whole decades, from two below the mark to one that contains every value. */
function logarithmicScale(values, mark) {
    const decade = (value, round) => round(Math.log10(value));
    const low = decade(mark, Math.floor) - 2;
    const high = Math.max(decade(Math.max(...values, mark), Math.ceil), low + 4);
    const step = Math.ceil((high - low) / 4);
    const ticks = Array.from({ length: Math.floor((high - low) / step) + 1 }, (_, k) => 10 ** (low + k * step));
    return { ticks, part: (value) => Math.max(0, (Math.log10(Math.max(value, 1e-12)) - low) / (high - low)) };
}

/** From zero to a round number above 98 % of the values, so that one outlier does not flatten the rest. */
function linearScale(values, least) {
    const sorted = [...values].sort((a, b) => a - b);
    const usual = sorted[Math.floor(0.98 * (sorted.length - 1))] ?? 0;
    const wanted = Math.max(1.1 * usual, least);
    const power = 10 ** Math.floor(Math.log10(wanted));
    const top = [1, 2, 4, 5, 10].map((factor) => factor * power).find((value) => value >= wanted);
    return { ticks: [0, top / 2, top], part: (value) => Math.min(value / top, 1.02) };
}
