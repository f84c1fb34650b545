/* The plots under the picture: quantities over time, with a cursor that moves with the motion. */

const BUCKETS = 700;      // places along the time axis; more samples than that are drawn as their envelope
const MOST_IN_BUCKET = 40;

/**
 * Sample functions of time over a span for a plot: `perSpan` is how many samples show every detail. Where that is more
 * than the plot has places, each place gets the least and the largest value of its samples, in the order of time.
 */
export function sampled(evaluate, start, stop, perSpan) {
    const each = Math.min(Math.max(Math.ceil(perSpan/BUCKETS), 1), MOST_IN_BUCKET), count = evaluate(start).length;
    const width = (stop - start)/BUCKETS, times = [], series = Array.from({length: count}, () => []);
    if (each === 1) {
        for (let k = 0; k <= BUCKETS; ++k) {
            const t = start + k*width, values = evaluate(Math.min(t, stop));
            times.push(t);
            series.forEach((column, i) => column.push(values[i]));
        }
        return {times, series, envelope: false};
    }
    for (let k = 0; k < BUCKETS; ++k) {
        const places = Array.from({length: each + 1}, (_, j) => evaluate(Math.min(start + (k + j/each)*width, stop)));
        times.push(start + (k + 0.25)*width, start + (k + 0.75)*width);
        series.forEach((column, i) => {
            const values = places.map((place) => place[i]), low = Math.min(...values), high = Math.max(...values);
            column.push(...(values.indexOf(low) <= values.indexOf(high) ? [low, high] : [high, low]));
        });
    }
    return {times, series, envelope: true};
}

/** Return a number as short text for an axis: 0.25, 4e-15. */
function short(value) {
    if (value === 0) return "0";
    const size = Math.abs(value);
    return size < 1e-3 || size >= 1e6 ? value.toExponential(1).replace(".0e", "e").replace("e+", "e") : String(Number(value.toPrecision(6)));
}

export class Panel {
    constructor(parent, {title, unit, names}, colours, moment, onSeek) {
        const figure = document.createElement("figure");
        figure.innerHTML = `<figcaption></figcaption><div class="plot"></div>`;
        this.caption = figure.querySelector("figcaption");
        this.caption.textContent = unit ? `${title}, ${unit}` : title;
        parent.append(figure);
        this.holder = figure.querySelector(".plot");
        const axis = {stroke: colours.text, grid: {stroke: colours.line, width: 1}, ticks: {stroke: colours.line}, font: "12px system-ui, sans-serif"};
        this.plot = new libraries.uPlot({
            width: 400, height: 160, legend: {show: true, live: false}, cursor: {drag: {x: true, y: false}, points: {show: false}},
            scales: {x: {time: false}},
            axes: [{...axis, size: 26, values: (_, ticks) => ticks.map(moment)}, {...axis, size: 58, values: (_, ticks) => ticks.map(short)}],
            series: [{}, ...names.map((name, k) => ({label: name, stroke: colours.series[k], width: 1.5, dash: k === 1 ? [6, 3] : k === 2 ? [2, 3] : undefined}))],
        }, [[0, 1], ...names.map(() => [0, 0])], this.holder);
        this.plot.over.addEventListener("click", (event) => onSeek(this.plot.posToVal(event.offsetX, "x")));
        this.line = document.createElement("div");
        this.line.className = "cursor";
        this.plot.over.append(this.line);
        this.time = 0;
        this.resize();
    }

    fill({times, series}) {
        this.plot.setData([times, ...series]);
        this.cursor(this.time);
    }

    /** Return the largest size of each curve. */
    largest() {
        return this.plot.data.slice(1).map((column) => column.reduce((most, value) => Math.max(most, Math.abs(value)), 0));
    }

    cursor(time) {
        this.time = time;
        const x = this.plot.valToPos(time, "x"), inside = x >= 0 && x <= this.plot.over.clientWidth;
        this.line.style.visibility = inside ? "visible" : "hidden";
        this.line.style.transform = `translateX(${x}px)`;
    }

    resize() {
        this.plot.setSize({width: Math.max(this.holder.clientWidth, 200), height: 160});
        this.cursor(this.time);
    }
}
