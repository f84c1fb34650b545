/* The motion of the scene with the numbers that a reader has chosen, and what is drawn of it at a time. */

function unpack(text, columns) {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const view = new DataView(bytes.buffer), rows = [];
    for (let k = 0; k < bytes.length/8; k += columns) {
        rows.push(Float64Array.from({length: columns}, (_, i) => view.getFloat64(8*(k + i), true)));
    }
    return rows;
}

const dot = (a, b) => a.reduce((sum, value, i) => sum + value*b[i], 0);
const cross = (a, b) => [a[1]*b[2] - a[2]*b[1], a[2]*b[0] - a[0]*b[2], a[0]*b[1] - a[1]*b[0]];
const times = (matrix, vector) => matrix.map((row) => dot(row, vector));

function rotate([w, x, y, z], v) {
    const u = [x, y, z], first = cross(u, v).map((value) => 2*value), second = cross(u, first);
    return v.map((value, i) => value + w*first[i] + second[i]);
}

/* --- the motion --------------------------------------------------------------------------------------------------- */

const MOMENTS = ["A", "B", "C"];

/** The scene with its present constants and initial values; `motion` is computed from them. */
class Model {
    constructor({constants, omega, quaternion} = data) {
        this.constants = {...constants};
        this.omega = [...omega];
        this.quaternion = [...quaternion];
        this.table = computed && readTableau(data.tableau);
        this.restart();
    }

    restart() {
        if (!computed) {
            this.motion = new SampledMotion(data.start, data.stop, unpack(data.samples, 7));
            return;
        }
        const values = Float64Array.from([...kernel.names.map((name) => this.constants[name]), Math.PI]);
        const fill = (name) => {
            const out = new Float64Array(kernel.sizes[name]);
            if (out.length) kernel[name](values, out);
            return out;
        };
        this.p = fill("rate_parameters");
        this.quantityParameters = fill("quantity_parameters");
        const {rates, takesParameters} = kernel;
        this.rates = takesParameters.rates ? rates : (t, y, p, dy) => rates(t, y, dy);
        this.out = new Float64Array(kernel.sizes.quantities);
        this.motion = new Motion({
            rates: this.rates, table: this.table, parameters: this.p, start: data.start, stop: data.stop,
            state: [...this.omega, ...this.quaternion], blocks: [[0, 3, 0], [3, 7, 1]], tolerance: data.tolerance,
            rest: this.omega.map((rate, k) => this.#rest(rate, data.omega[k], data.omegaRest[k])),
            invariants: data.free && this.constants.A !== undefined ? this.#invariants() : null,
        });
    }

    /** Return what a double lacks of the exact number of the scene; zero if a reader has changed it. */
    #rest(value, original, rest) {
        return value === original ? rest : 0;
    }

    #invariants() {
        const {constants} = this;
        const moments = MOMENTS.map((name, k) => [constants[name], this.#rest(constants[name], data.constants[name], data.momentsRest[k])]);
        return new FreeBody(moments, this.omega.map((rate, k) => [rate, this.#rest(rate, data.omega[k], data.omegaRest[k])]));
    }

    get inertia() {
        const c = this.constants ?? {};
        if (!computed || c.A === undefined) return data.inertia;
        return [[c.A, 0, 0], [0, c.B, 0], [0, 0, c.C]];
    }

    /**
     * Return how the drawn body has to be stretched to have the present moments: factors along the body axes, and the
     * points that stay (`from`) and where they go (`to`), m. Stretching a body along principal axes multiplies its second
     * moments, such as (B + C - A)/2, by the squares of the factors. `note` says what the picture shows.
     */
    get stretch() {
        const same = {factors: [1, 1, 1], from: [0, 0, 0], to: [0, 0, 0], note: ""};
        const {constants: c} = this, old = data.constants;
        if (!computed || c.A === undefined) return same;
        const place = (numbers) => [1, 2, 3].map((k) => numbers[`center_of_mass_${k}`] ?? data.center?.[k - 1] ?? 0);
        const isMoved = data.fixedPoint && data.mass !== null && data.center !== null && !data.drawn.includes("proportions");
        const from = isMoved ? data.center : [0, 0, 0], to = isMoved ? place(c) : [0, 0, 0];
        const same3 = (a, b) => a.every((value, k) => value === b[k]);
        const moments = (numbers) => MOMENTS.map((name) => numbers[name]);
        if (same3(moments(c), moments(old)) && same3(place(c), place(old))) return same;
        const second = (numbers, center) => moments(numbers).map((moment, k, all) => (all[0] + all[1] + all[2])/2 - moment - (isMoved ? data.mass*center[k]**2 : 0));
        const before = second(old, from), after = second(c, to), least = 1e-9*Math.max(...moments(c)), flat = 1e-9*Math.max(...moments(old));
        const isOffAxis = (center) => center.filter((value) => Math.abs(value) > 1e-12*data.size).length > 1;
        if (after.some((value) => value < -least) || isMoved && (isOffAxis(from) || isOffAxis(to))) {
            return {...same, note: "The picture keeps the body of the scene: it cannot be stretched to these moments and this centre of mass."};
        }
        const factors = before.map((value, k) => value <= flat ? 1 : Math.sqrt(Math.max(after[k], 0)/value));
        const isFlat = before.some((value, k) => value <= flat && after[k] > least);
        const note = isFlat ? "The body is drawn stretched along its axes, but stays flat, which these moments do not allow."
            : "The body is drawn stretched along its axes, so that it has these moments.";
        return {factors, from, to, note};
    }

    /** Return the local vertical of a satellite, from the planet outward, at a time; null without a gravity gradient. */
    localVertical(t) {
        const rate = this.constants?.[data.orbit?.constant] ?? data.orbit?.rate;
        return rate === undefined ? null : [Math.cos(rate*t), Math.sin(rate*t), 0];
    }

    /** Return the index of the axis of a body with two equal moments, or -1; the three moments of a sphere count as none. */
    get symmetryAxis() {
        const m = this.moments, same = (a, b) => Math.abs(a - b) <= 1e-12*Math.max(a, b);
        const axes = [0, 1, 2].filter((k) => same(m[(k + 1) % 3], m[(k + 2) % 3]));
        return axes.length === 1 ? axes[0] : -1;
    }

    get moments() {
        const c = this.constants ?? {};
        return c.A === undefined ? data.principal : [c.A, c.B, c.C];
    }

    /** Return the values of the kernel's quantities for a state. */
    quantities(t, y) {
        const {quantities, takesParameters} = kernel;
        if (takesParameters.quantities) quantities(t, y, this.quantityParameters, this.out);
        else quantities(t, y, this.out);
        return this.out;
    }

    /** Return everything that is drawn at a time. */
    at(t) {
        const y = this.motion.at(t);
        const length = Math.hypot(y[3], y[4], y[5], y[6]);
        const quaternion = [y[3]/length, y[4]/length, y[5]/length, y[6]/length], omega = [y[0], y[1], y[2]];
        const state = {t, y, quaternion, omegaBody: omega, omega: rotate(quaternion, omega)};
        state.axis = rotate(quaternion, data.axis);
        state.vertical = this.localVertical(t);
        const ownMomentum = times(this.inertia, omega);
        if (!computed) {
            state.momentum = rotate(quaternion, ownMomentum.map((value, i) => value + data.rotor[i]));
            state.torque = null;
            state.energy = dot(ownMomentum, omega)/2;
            return state;
        }
        const out = this.quantities(t, y), places = data.outputs;
        const momentum = [1, 2, 3].map((k) => out[places[`momentum_${k}`]]);
        state.kinetic = out[places.kinetic_energy];
        state.energy = out[places.energy];
        state.conserved = data.conserved.map(({output}) => out[output]);
        state.momentum = rotate(quaternion, momentum);
        const dy = this.dy ??= new Float64Array(7);
        this.rates(t, y, this.p, dy);
        const change = cross(omega, momentum);
        state.torque = rotate(quaternion, times(this.inertia, [dy[0], dy[1], dy[2]]).map((value, i) => value + change[i]));
        const floor = 1e-9*Math.hypot(...momentum)*Math.hypot(...omega);     // what rounding leaves of a torque of zero
        if (Math.hypot(...state.torque) <= floor) state.torque = null;
        return state;
    }

    /**
     * Return the largest difference from symrot's own motion: of ω relative to its size, and of the quaternion; null if the
     * motion ends before the first time after the start at which it could be compared.
     */
    agreement() {
        const at = unpack(data.reference.t, 1), states = unpack(data.reference.y, 7);
        const largest = Math.max(...states.map((y) => Math.hypot(y[0], y[1], y[2]))) || 1;
        let worst = 0;
        if (this.motion.t < at[1][0]) return null;
        states.forEach((expected, k) => {
            if (at[k][0] > this.motion.t) return;
            const y = this.motion.at(at[k][0]);
            const sign = y[3]*expected[3] + y[4]*expected[4] + y[5]*expected[5] + y[6]*expected[6] < 0 ? -1 : 1;
            for (let i = 0; i < 7; ++i) {
                const difference = i < 3 ? (y[i] - expected[i])/largest : sign*y[i] - expected[i];
                worst = Math.max(worst, Math.abs(difference));
            }
        });
        return worst;
    }

    get isOriginal() {
        const same = (a, b) => a.every((value, i) => value === b[i]);
        return !computed || same(this.omega, data.omega) && same(this.quaternion, data.quaternion)
            && Object.entries(data.constants).every(([name, value]) => this.constants[name] === value);
    }
}

