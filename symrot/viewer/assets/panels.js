/* The plots under the picture: quantities over time, with a cursor that moves with the motion. */

const FEWEST_SAMPLES = 700, MOST_SAMPLES = 28000;      // of a plot
const GOLDEN = (Math.sqrt(5) - 1)/2;
const LEAST_PER_PERIOD = 5;       // pixels: a curve with shorter periods is drawn as the band between its extremes
const PERIODS_IN_BIN = 2;         // of such a curve, in each piece of its band
const VISIBLE = 3;                // pixels: oscillations that are smaller do not count
const QUIET = 0.01;               // a component that changes by less than this part of its size may be written, not drawn
const DASHES = [undefined, [7, 4], [2, 3], [9, 3, 2, 3]];
const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";
const LOWEST = -17;               // power of ten below which a relative change is not drawn

/** Return the times of a plot's samples; `detail` is how many samples show every detail of the motion. */
export function sampleTimes(start, stop, detail) {
    const count = Math.min(Math.max(detail, FEWEST_SAMPLES), MOST_SAMPLES), width = (stop - start)/(count - 1);
    return Float64Array.from({length: count}, (_, k) => {
        if (k === 0 || k === count - 1) return k === 0 ? start : stop;
        // too few to follow each period: irregular times, or all could fall on the same few angles of the rotation
        return start + (k + (detail > MOST_SAMPLES ? (k*GOLDEN) % 1 - 0.5 : 0))*width;
    });
}

/** Return ten to an integer power as text: 10⁻⁵. */
export const powerOfTen = (power) => `10${power < 0 ? "⁻" : ""}${[...String(Math.abs(power))].map((digit) => SUPERSCRIPTS[digit]).join("")}`;

/** Return round numbers in a range, at most about `most`; steps are 1, 2 or 5 times a power of ten, or in `steps`. */
export function ticks(low, high, most, steps = []) {
    const coarse = (high - low)/Math.max(most, 1)*(1 - 1e-9), power = 10**Math.floor(Math.log10(coarse));
    if (!(coarse > 0) || !Number.isFinite(coarse)) return {step: 1, values: [low]};
    const sizes = coarse > steps[0] ? steps : [1, 2, 5, 10].map((factor) => factor*power);
    const step = sizes.find((size) => size >= coarse) ?? Math.ceil(coarse/sizes.at(-1))*sizes.at(-1);
    const values = [];
    for (let k = Math.ceil(low/step - 1e-9); k <= high/step + 1e-9; ++k) values.push(k*step);
    return values.length > 1 || most > 8 ? {step, values} : ticks(low, high, 1.5*most, steps);
}

/** Return a multiple of a step as text, with the digits that the step needs. */
function tickText(value, step) {
    const places = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const text = (Math.abs(value) < step/2 ? 0 : value).toFixed(Math.min(places, 20));
    return text.replace("-", "−");
}

/**
 * Insert what interrupts curves of angles: where an angle passes the end of its range, the curve is drawn to the end,
 * interrupted, and goes on at the other end. `turn` is a whole rotation. All samples stay.
 */
export function withGaps(t, columns, turn) {
    const times = [], series = columns.map(() => []);
    for (let k = 0; k < t.length; ++k) {
        const jumps = k ? columns.map((column) => column[k] - column[k - 1]) : [];
        const breaks = jumps.map((jump, i) => {
            if (Math.abs(jump) > turn/2) return "wrap";
            const steady = 8*Math.max(Math.abs(columns[i][k - 1] - (columns[i][k - 2] ?? columns[i][k - 1])), Math.abs((columns[i][k + 1] ?? columns[i][k]) - columns[i][k]));
            return Math.abs(jump) > turn/4 && Math.abs(jump) > steady ? "jump" : "";
        });
        const wraps = breaks.map((kind, i) => kind && i).filter((i) => i !== "").map((i) => {
            if (breaks[i] === "jump") return {i, part: 0.5, end: null};
            const end = jumps[i] < 0 ? turn/2 : -turn/2, rise = jumps[i] - Math.sign(jumps[i])*turn;
            return {i, part: Math.min(Math.max((end - columns[i][k - 1])/rise, 0), 1), end};
        }).sort((a, b) => a.part - b.part);
        for (const [place, {i, part, end}] of wraps.entries()) {
            const passed = wraps.slice(0, place).map((other) => other.i);
            for (const value of end === null ? [null] : [end, null, -end]) {
                times.push(t[k - 1] + part*(t[k] - t[k - 1]));
                series.forEach((curve, j) => {
                    if (j === i) curve.push(value);
                    else if (!breaks[j]) curve.push(columns[j][k - 1] + part*jumps[j]);
                    else curve.push(passed.includes(j) ? columns[j][k] : columns[j][k - 1]);
                });
            }
        }
        times.push(t[k]);
        series.forEach((curve, i) => curve.push(Number.isFinite(columns[i][k]) ? columns[i][k] : null));
    }
    return {times, series};
}

/** Return the band between the extremes of a curve, as pieces [time, low, high], or null if the curve is drawn as a line. */
export function band(t, column, pixels, visible) {
    let turns = 0, slope = 0;
    for (let k = 1; k < t.length; ++k) {
        const sign = Math.sign(column[k] - column[k - 1]);
        if (sign && slope && sign !== slope) ++turns;
        if (sign) slope = sign;
    }
    if (turns/2*LEAST_PER_PERIOD <= pixels) return null;
    const count = Math.max(1, Math.floor(Math.min(pixels, turns/2/PERIODS_IN_BIN))), pieces = [];
    const first = t[0], width = (t[t.length - 1] - first)/count;
    for (let k = 0, bin = 0; bin < count; ++bin) {
        let low = Infinity, high = -Infinity;
        for (; k < t.length && (t[k] <= first + (bin + 1)*width || bin === count - 1); ++k) {
            if (column[k] < low) low = column[k];
            if (column[k] > high) high = column[k];
        }
        if (low <= high) pieces.push([first + bin*width, low, high]);
    }
    if (!pieces.length) return null;
    const heights = pieces.map(([, low, high]) => high - low).sort((a, b) => a - b);
    if (!(heights[heights.length >> 1] > visible)) return null;
    const edges = [...pieces, [t[t.length - 1], ...pieces.at(-1).slice(1)]];
    return edges.map(([time, low, high], k) => k ? [time, Math.min(low, pieces[k - 1][1]), Math.max(high, pieces[k - 1][2])] : [time, low, high]);
}

/** A plot of one or several curves over time. */
export class Panel {
    /**
     * `kind` of the definition is "angle" for angles in degrees that have a range of one rotation, "drift" for relative
     * changes, drawn as the powers of ten of the largest so far, and empty otherwise. `clock` is the unit of time:
     * its size, s, and its name.
     */
    constructor(parent, definition, colours, clock, onSeek) {
        Object.assign(this, {definition, colours, clock, time: 0, factor: 1, bands: [], low: 0, high: 1});
        const figure = document.createElement("figure");
        figure.innerHTML = `<figcaption><span class="name"></span> <span class="unit"></span><span class="keys"></span></figcaption><div class="plot" role="img"></div>`;
        this.caption = figure.querySelector("figcaption");
        this.caption.querySelector(".name").textContent = definition.title;
        this.holder = figure.querySelector(".plot");
        parent.append(figure);
        const size = parseFloat(getComputedStyle(document.body).fontSize)*0.82, font = `${size}px system-ui, sans-serif`;
        this.height = Math.round(11*size);
        const axis = {
            stroke: () => colours.text, font, labelFont: font, gap: 4,
            grid: {stroke: () => colours.line, width: 1}, ticks: {stroke: () => colours.line, size: 4, width: 1},
        };
        const splits = (isTime) => (plot, _, low, high) => {
            const room = isTime ? plot.bbox.width/devicePixelRatio/(6*size) : plot.bbox.height/devicePixelRatio/(2*size);
            const steps = !isTime && definition.kind === "angle" && this.factor === 1 ? [1, 2, 5, 10, 15, 30, 45, 90, 180] : [];
            const {step, values} = ticks(low, high, room, !isTime && definition.kind === "drift" ? [1, 2, 3, 5, 10] : steps);
            this[isTime ? "timeStep" : "step"] = step;
            return values;
        };
        this.plot = new libraries.uPlot({
            width: 400, height: this.height, legend: {show: false}, padding: [null, 2*size, null, null],
            cursor: {drag: {x: true, y: false}, points: {show: false}},
            scales: {x: {time: false, range: (_, low, high) => high > low ? [low, high] : [(low ?? 0) - 0.5, (low ?? 0) + 0.5]}, y: {range: () => [this.low, this.high]}},
            axes: [
                {...axis, size: 1.7*size, label: `t, ${clock[1]}`, labelSize: 1.3*size, labelGap: 0, splits: splits(true), values: (_, all) => all.map((value) => tickText(value, this.timeStep))},
                {...axis, size: 4.2*size, splits: splits(false), values: (_, all) => all.map((value) => definition.kind === "drift" ? powerOfTen(Math.round(value)) : tickText(value, this.step))},
            ],
            series: [{}, ...definition.names.map((name, k) => ({
                label: name, stroke: () => this.#colour(k), width: 1.6, dash: DASHES[k % DASHES.length], points: {show: false},
                paths: (plot, number, first, last) => this.#line(plot, number, first, last),
            }))],
            hooks: {draw: [(plot) => this.#drawBands(plot)]},
        }, [[0, 1], ...definition.names.map(() => [null, null])], this.holder);
        this.plot.over.addEventListener("click", (event) => onSeek(this.plot.posToVal(event.offsetX, "x")*clock[0]));
        this.line = document.createElement("div");
        this.line.className = "cursor";
        this.plot.over.append(this.line);
        this.resize();
    }

    /** Show curves: `t` are times, s, and `columns` their values. */
    fill(t, columns) {
        const {definition: {kind, unit, names}, clock} = this;
        this.raw = columns.map((column) => column.reduce((most, value) => Math.max(most, Math.abs(value)), 0));      // NaN if a value is none
        let drawn = columns;
        if (kind === "drift") drawn = columns.map((column) => {
            let most = 0;
            return column.map((value) => (most = Math.max(most, Math.abs(value))) > 0 ? Math.max(Math.log10(most), LOWEST) : NaN);
        });
        const spans = drawn.map((column) => column.reduce(([low, high], value) => [value < low ? value : low, value > high ? value : high], [Infinity, -Infinity]));
        const size = ([low, high]) => Math.max(Math.abs(low), Math.abs(high)), steady = ([low, high]) => high - low <= QUIET*Math.max(Math.abs(low), Math.abs(high));
        const others = Math.max(0, ...spans.filter((span) => !steady(span)).map(size));
        const written = spans.map((span) => !kind && steady(span) && others > 0 && size(span) > 3*others);
        const visible = spans.filter(([low, high], k) => low <= high && !written[k]);
        const largest = Math.max(0, ...visible.map(size));
        const power = kind === "drift" || !(largest > 0) || largest >= 0.01 && largest < 1e4 ? 0 : Math.floor(Math.log10(largest));
        this.factor = 10**power;
        let low = Math.min(...visible.map(([value]) => value))/this.factor, high = Math.max(...visible.map(([, value]) => value))/this.factor;
        if (!(low <= high)) [low, high] = kind === "drift" ? [LOWEST, LOWEST + 2] : [0, 1];
        if (kind === "drift") [this.low, this.high] = [Math.floor(low) - 0.3, Math.ceil(high) + 1];
        else if (kind === "angle" && power === 0 && high - low > 200) [this.low, this.high] = [Math.floor(low/90 + 1e-6)*90 - 4, Math.ceil(high/90 - 1e-6)*90 + 4];
        else {
            const margin = high - low > 1e-6*Math.max(Math.abs(low), Math.abs(high)) ? 0.06*(high - low) : 0.5*Math.abs(high) || 1;
            [this.low, this.high] = [low - margin, high + margin];
        }
        drawn = drawn.map((column, k) => written[k] ? column.map(() => NaN) : this.factor === 1 ? column : column.map((value) => value/this.factor));
        const pixels = this.holder.clientWidth || 400, eye = VISIBLE*(this.high - this.low)/this.height;
        this.bands = drawn.map((column, k) => kind === "drift" || written[k] ? null : band(t, column, pixels, eye)?.map(([time, ...ends]) => [time/clock[0], ...ends]));
        const lines = drawn.map((column, k) => this.bands[k] ? column.map(() => NaN) : column);
        const {times, series} = withGaps(t, lines, kind === "angle" ? 360/this.factor : Infinity);
        const shown = power ? `${powerOfTen(power)} ${unit}` : unit;
        this.caption.querySelector(".unit").textContent = shown;
        this.#keys(names.map((name, k) => {
            if (written[k]) return `${name} = ${this.#value(spans[k])} ${unit}`;
            return kind !== "drift" || this.raw[k] > 0 ? name : this.raw[k] === 0 ? `${name} (no change)` : `${name} (no number)`;
        }), written);
        const inWords = kind === "drift" ? this.raw.map((most, k) => `${names[k]} at most ${most.toPrecision(2)}`)
            : spans.map(([from, to], k) => from <= to ? `${names[k]} from ${Number(from.toPrecision(4))} to ${Number(to.toPrecision(4))}` : "").filter(Boolean);
        this.holder.setAttribute("aria-label", `${this.definition.title}${unit && ` ${unit}`}: ${inWords.join("; ")}`);
        this.plot.setData([times.map((time) => time/clock[0]), ...series]);
        this.cursor(this.time);
    }

    #colour(curve) {
        return this.colours.series[curve % this.colours.series.length];
    }

    #value([low, high]) {
        const [first, last] = [low, high].map((value) => {
            const [factor, power] = value.toExponential(4).split("e");
            return value === 0 || Math.abs(power) < 4 ? String(Number(value.toPrecision(5))) : `${Number(factor)}·${powerOfTen(Number(power))}`;
        });
        return first === last ? first : `${first} to ${last}`;
    }

    /** Write the names of the curves beside the title, each with a piece of its line; one curve needs none. */
    #keys(texts, written) {
        const keys = this.caption.querySelector(".keys");
        keys.replaceChildren();
        if (texts.length === 1 && !this.bands[0]) return;
        const shaded = this.bands.some(Boolean);
        texts.forEach((text, k) => {
            const key = document.createElement("span"), dash = DASHES[k % DASHES.length];
            const mark = written[k] ? "" : this.bands[k] ? `<rect y="1" width="22" height="8" fill="currentColor" fill-opacity="0.35" stroke="currentColor"/>`
                : `<path d="M0 5H22" stroke="currentColor" stroke-width="2" ${dash ? `stroke-dasharray="${dash.join(" ")}"` : ""}/>`;
            key.innerHTML = `${mark && `<svg width="22" height="10" aria-hidden="true">${mark}</svg>`}<b></b>`;
            if (mark) Object.assign(key.querySelector("svg").dataset, {curve: k});
            if (mark) key.querySelector("svg").style.color = this.#colour(k);
            key.querySelector("b").textContent = text;
            keys.append(key);
        });
        if (shaded) {
            const note = document.createElement("span");
            note.textContent = "shaded: too fast to draw, its range";
            keys.append(note);
        }
    }

    /** Return the path of a curve through every sample, interrupted at gaps, however narrow they are. */
    #line({data, valToPos}, number, first, last) {
        const stroke = new Path2D(), times = data[0], values = data[number];
        for (let k = first, isOpen = false; k <= last; ++k) {
            if (values[k] === null) isOpen = false;
            else {
                const x = valToPos(times[k], "x", true), y = valToPos(values[k], "y", true);
                if (isOpen) stroke.lineTo(x, y);
                else stroke.moveTo(x, y);
                isOpen = true;
            }
        }
        return {stroke, fill: null, clip: null};
    }

    #drawBands(plot) {
        const {ctx, bbox} = plot;
        ctx.save();
        ctx.beginPath();
        ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
        ctx.clip();
        ctx.setLineDash([]);
        this.bands.forEach((pieces, k) => {
            if (!pieces) return;
            const at = (time, value) => [plot.valToPos(time, "x", true), plot.valToPos(value, "y", true)];
            ctx.beginPath();
            for (const [time, , high] of pieces) ctx.lineTo(...at(time, high));
            for (const [time, low] of pieces.toReversed?.() ?? [...pieces].reverse()) ctx.lineTo(...at(time, low));
            ctx.closePath();
            ctx.strokeStyle = ctx.fillStyle = this.#colour(k);
            ctx.globalAlpha = 0.3;
            ctx.fill();
            ctx.globalAlpha = 1;
            ctx.stroke();
        });
        ctx.restore();
    }

    /** Return the largest size of each curve. */
    largest() {
        return this.raw;
    }

    cursor(time) {
        this.time = time;
        const x = this.plot.valToPos(time/this.clock[0], "x"), width = this.plot.bbox.width/devicePixelRatio;
        this.line.style.visibility = x >= 0 && x <= width ? "visible" : "hidden";
        this.line.style.transform = `translateX(${x}px)`;
    }

    resize() {
        const width = Math.max(this.holder.clientWidth, 200);
        if (width !== this.plot.width) this.plot.setSize({width, height: this.height});
        this.cursor(this.time);
    }

    /** Draw again in the present colours. */
    redraw() {
        for (const mark of this.caption.querySelectorAll("svg")) mark.style.color = this.#colour(Number(mark.dataset.curve));
        this.plot.redraw(false, true);
    }
}
