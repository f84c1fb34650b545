/*
 * The motion of a scene, computed in the page: Dormand-Prince 8(5,3) with dense output of order 7.
 *
 * The coefficients come from symrot/propagation/steppers/tableau.py, which names the source; the control of the step is
 * that of dop853.c. A motion is computed as far as it is asked for, and kept.
 */

const SAFETY = 0.9, GROWTH = 6.0, SHRINK = 1/3, COLLAPSE = 0.1;
const RATE_FLOOR = 1e-3;         // rad: errors of rates are relative to at least this per step
const ROUND_OFF = 2*2**-52;      // smallest error that a step can have
export const MOST_STEPS = 200000;

/**
 * Return the coefficients as rows of numbers, from the tableau as text: stages without a coefficient have 0.
 */
export function readTableau(tableau) {
    const row = (coefficients, length) => Array.from({length}, (_, k) => Number(coefficients[k + 1] ?? 0));
    const table = {nodes: row(tableau.nodes, 16), stages: [], dense: []};
    for (let stage = 1; stage <= 16; ++stage) table.stages.push(row(tableau.stages[stage] ?? {}, 16));
    for (let order = 5; order <= 8; ++order) table.dense.push(row(tableau.dense[order], 16));
    table.weights = row(tableau.weights, 12);
    table.third = row(tableau.weights_3, 12);
    table.fifth = row(tableau.error_5, 12);
    return table;
}

function length(values, from, to) {
    let sum = 0;
    for (let i = from; i < to; ++i) sum += values[i]*values[i];
    return Math.sqrt(sum);
}

/* --- numbers of two doubles: their sum is the number, the second is below the last bit of the first ------------------ */

function twoSum(a, b) {
    const sum = a + b, part = sum - a;
    return [sum, (a - (sum - part)) + (b - part)];
}

function twoProduct(a, b) {
    const split = (x) => {
        const big = 134217729*x, high = big - (big - x);      // 2^27 + 1
        return [high, x - high];
    };
    const product = a*b, [ah, al] = split(a), [bh, bl] = split(b);
    return [product, ((ah*bh - product) + ah*bl + al*bh) + al*bl];
}

function add([a, b], [c, d]) {
    const [sum, rest] = twoSum(a, c);
    return twoSum(sum, rest + b + d);
}

function multiply([a, b], [c, d]) {
    const [product, rest] = twoProduct(a, c);
    return twoSum(product, rest + a*d + b*c);
}

/**
 * The energy and the angular momentum of a free body in principal axes, kept to 30 digits.
 *
 * Near a separatrix the period depends so strongly on both that their rounding to doubles would be seen. After each step
 * the angular velocity is moved by the shortest vector that restores them; it goes into the part below the last bit.
 */
export class FreeBody {
    constructor(moments, omega) {
        this.moments = moments;
        this.squares = moments.map((moment) => multiply(moment, moment));
        this.energy = this.#form(this.moments, omega);
        this.momentum = this.#form(this.squares, omega);
    }

    /** Return the sum of factor k times omega_k^2. */
    #form(factors, omega) {
        return omega.reduce((sum, rate, k) => add(sum, multiply(factors[k], multiply(rate, rate))), [0, 0]);
    }

    restore(y, carry) {
        const omega = [0, 1, 2].map((k) => twoSum(y[k], carry[k]));
        const minus = ([a, b]) => [-a, -b];
        const r = add(this.#form(this.moments, omega), minus(this.energy))[0];
        const s = add(this.#form(this.squares, omega), minus(this.momentum))[0];
        const g = omega.map(([rate], k) => 2*this.moments[k][0]*rate), h = omega.map(([rate], k) => 2*this.squares[k][0]*rate);
        const dot = (a, b) => a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
        const gg = dot(g, g), gh = dot(g, h), hh = dot(h, h), determinant = gg*hh - gh*gh;
        if (!(determinant > 1e-14*gg*hh)) return;      // both gradients are parallel: the body rotates about an axis
        const a = (r*hh - s*gh)/determinant, b = (s*gg - r*gh)/determinant;
        for (let k = 0; k < 3; ++k) {
            const [sum, rest] = twoSum(y[k], carry[k] - a*g[k] - b*h[k]);
            y[k] = sum;
            carry[k] = rest;
        }
    }
}

/**
 * A motion from its start. `rates(t, y, p, dy)` fills dy; `blocks` are [first, last + 1, size] of the states with an
 * error norm of their own: size 0 for rates (errors are relative to the block), 1 for a quaternion. `rest` is what the
 * doubles of the state lack, and `invariants`, a FreeBody, restores conserved quantities after each step.
 */
export class Motion {
    constructor({rates, table, parameters, start, stop, state, blocks, tolerance, rest = [], invariants = null}) {
        Object.assign(this, {rates, table, parameters, start, stop, blocks, tolerance, invariants});
        const n = state.length;
        this.size = n;
        this.t = start;
        this.y = Float64Array.from(state);
        this.carry = Float64Array.from({length: n}, (_, i) => rest[i] ?? 0);      // what rounding has removed from y
        this.k = Array.from({length: 17}, () => new Float64Array(n));   // stages, numbered from 1
        this.times = [start];                 // ends of the steps
        this.steps = [];                      // coefficients of the dense output, 8 n numbers for each step
        this.growth = GROWTH;
        this.failure = "";
        this.rates(start, this.y, this.parameters, this.k[1]);
        this.h = this.#firstStep();
    }

    #firstStep() {
        let rate = 0;
        for (const [from, to, size] of this.blocks) {
            const own = size || Math.max(length(this.y, from, to), Math.sqrt(length(this.k[1], from, to)));
            if (own > 0) rate = Math.max(rate, length(this.k[1], from, to)/own);
        }
        const span = this.stop - this.start;
        return Math.min(rate > 0 ? this.tolerance**0.125/rate/4 : span/100, span);
    }

    #stage(stage, h) {
        const {k, y, table} = this, z = this.z ??= new Float64Array(this.size), row = table.stages[stage - 1];
        for (let i = 0; i < this.size; ++i) {
            let sum = 0;
            for (let s = 1; s < stage; ++s) if (row[s - 1] !== 0) sum += row[s - 1]*k[s][i];
            z[i] = y[i] + h*sum;
        }
        this.rates(this.t + table.nodes[stage - 1]*h, z, this.parameters, k[stage]);
    }

    /** Return the error of a step relative to the allowed one, from the embedded formulas of order 5 and 3. */
    #error(h, end) {
        const {k, y, table} = this;
        let worst = 0;
        for (const [from, to, fixed] of this.blocks) {
            let fifth = 0, third = 0;
            for (let i = from; i < to; ++i) {
                let five = 0, three = 0;
                for (let s = 1; s <= 12; ++s) {
                    five += table.fifth[s - 1]*k[s][i];
                    three += (table.weights[s - 1] - table.third[s - 1])*k[s][i];
                }
                fifth += five*five;
                third += three*three;
            }
            const size = fixed || Math.max(length(y, from, to), length(end, from, to), RATE_FLOOR/h);
            const norm = fifth + 0.01*third;
            const error = norm > 0 ? h*fifth/Math.sqrt(norm)/size : 0;
            worst = Math.max(worst, Number.isFinite(error) && Number.isFinite(size) ? error : Infinity);      // an infinite size hides any error
        }
        return worst/Math.max(this.tolerance, ROUND_OFF);
    }

    /** Do one accepted step; return false if the motion cannot go on. */
    #step() {
        const {k, table, size} = this, end = new Float64Array(size), rise = new Float64Array(size);
        for (;;) {
            const last = this.t + this.h*(1 + 1e-12) >= this.stop;
            const h = (last ? this.stop : this.t + this.h) - this.t;      // what the clock really moves by
            if (this.steps.length >= MOST_STEPS) return this.#fail(`a page computes at most ${MOST_STEPS} steps, and they end`);
            if (!(h > 4*2**-52*Math.abs(this.t))) return this.#fail(this.isInfinite ? "its numbers grow beyond all bounds" : "its steps fall below the rounding of time");
            for (let stage = 2; stage <= 12; ++stage) this.#stage(stage, h);
            for (let i = 0; i < size; ++i) {
                let sum = 0;
                for (let s = 1; s <= 12; ++s) sum += table.weights[s - 1]*k[s][i];
                rise[i] = h*sum;
                end[i] = this.y[i] + rise[i];
            }
            const error = this.#error(h, end);
            this.isInfinite = error === Infinity;
            if (error === Infinity) {
                this.h = COLLAPSE*h;
                this.growth = 1;
                continue;
            }
            const factor = SAFETY*error**(-1/8);
            if (error > 1) {
                this.h = h*Math.max(SHRINK, factor);
                this.growth = 1;
                continue;
            }
            const tNext = last ? this.stop : this.t + h;
            this.rates(tNext, end, this.parameters, k[13]);
            this.#record(h, rise);
            for (let i = 0; i < size; ++i) {    // compensated sum
                const added = rise[i] + this.carry[i], sum = this.y[i] + added;
                this.carry[i] = added - (sum - this.y[i]);
                this.y[i] = sum;
            }
            this.invariants?.restore(this.y, this.carry);
            this.t = tNext;
            this.times.push(tNext);
            [k[1], k[13]] = [k[13], k[1]];
            this.h = h*Math.min(this.growth, Math.max(SHRINK, factor));
            this.growth = GROWTH;
            return true;
        }
    }

    #fail(reason) {
        this.failure = `${reason} at t = ${this.t.toPrecision(6)} s`;
        return false;
    }

    #record(h, rise) {
        const {k, table, size, y} = this;
        for (let stage = 14; stage <= 16; ++stage) this.#stage(stage, h);
        const terms = new Float64Array(8*size);
        for (let i = 0; i < size; ++i) {
            const bend = h*k[1][i] - rise[i];
            terms[i] = y[i];
            terms[size + i] = rise[i];
            terms[2*size + i] = bend;
            terms[3*size + i] = rise[i] - h*k[13][i] - bend;
            for (let order = 0; order < 4; ++order) {
                let sum = 0;
                for (let s = 1; s <= 16; ++s) sum += table.dense[order][s - 1]*k[s][i];
                terms[(4 + order)*size + i] = h*sum;
            }
        }
        this.steps.push(terms);
    }

    /** How many samples show every detail of the motion. */
    get detail() {
        return 3*this.steps.length;
    }

    /** Compute the motion up to a time, or up to a number of further steps; return the time reached. */
    reach(time, mostSteps = Infinity) {
        while (this.t < Math.min(time, this.stop) && !this.failure && mostSteps-- > 0) this.#step();
        return this.t;
    }

    /** Fill `out` with the state at a time that the motion has reached, and return it. */
    at(time, out = new Float64Array(this.size)) {
        const {times, steps, size} = this;
        if (steps.length === 0) {
            out.set(this.y);
            return out;
        }
        let low = 0, high = steps.length - 1;
        while (low < high) {
            const middle = (low + high + 1) >> 1;
            if (times[middle] <= time) low = middle;
            else high = middle - 1;
        }
        const s = (time - times[low])/(times[low + 1] - times[low]), r = 1 - s, c = steps[low];
        for (let i = 0; i < size; ++i) {
            out[i] = c[i] + s*(c[size + i] + r*(c[2*size + i] + s*(c[3*size + i] + r*(c[4*size + i]
                + s*(c[5*size + i] + r*(c[6*size + i] + s*c[7*size + i]))))));
        }
        return out;
    }
}

/**
 * A motion given by evenly spaced samples of omega and quaternion. Between samples omega is the cubic through four
 * samples, and the quaternion the cubic whose slope is q*(0, omega)/2 at both ends.
 */
export class SampledMotion {
    constructor(start, stop, states) {
        Object.assign(this, {start, stop, states, t: stop, failure: "", size: 7, detail: states.length});
    }

    reach() {
        return this.t;
    }

    static #slope(y, i) {
        const [a, b, c, p, q, r, s] = y;
        return [-q*a - r*b - s*c, p*a + r*c - s*b, p*b + s*a - q*c, p*c + q*b - r*a][i]/2;
    }

    at(time, out = new Float64Array(7)) {
        const {states, start, stop} = this, h = (stop - start)/(states.length - 1);
        const place = Math.min(Math.max((time - start)/h, 0), states.length - 1);
        const low = Math.min(Math.floor(place), states.length - 2), s = place - low, r = 1 - s;
        const a = states[low], b = states[low + 1];
        const before = states[Math.max(low - 1, 0)], after = states[Math.min(low + 2, states.length - 1)];
        const inside = low > 0 && low + 2 < states.length;
        for (let i = 0; i < 3; ++i) {
            const line = r*a[i] + s*b[i];      // and the cubic through four samples, except at the ends
            out[i] = inside ? line - s*r/6*((2 - s)*(before[i] - 2*a[i] + b[i]) + (1 + s)*(a[i] - 2*b[i] + after[i])) : line;
        }
        for (let i = 0; i < 4; ++i) {
            const first = h*SampledMotion.#slope(a, i), last = h*SampledMotion.#slope(b, i), rise = b[3 + i] - a[3 + i];
            out[3 + i] = a[3 + i] + s*(rise + r*(r*(first - rise) + s*(rise - last)));
        }
        return out;
    }
}
