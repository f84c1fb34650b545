/* The page: it computes the motion, lets people play and change it, and says how far it can be trusted. */

const KEYS = "space: play or pause; left, right: step; home: start; up, down: faster, slower; b: view from the body; f: full screen";
const REDUCED = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
const PANEL_COLOURS = {light: ["#0072B2", "#D55E00", "#009E73", "#9b4f8a"], dark: ["#56B4E9", "#ff9b54", "#3ddbA5", "#e39ccb"]};

const data = JSON.parse(document.getElementById("data").textContent);
const computed = !data.played;      // whether the page computes the motion, or plays samples of it
const element = (id) => document.getElementById(id);
const dark = window.matchMedia("(prefers-color-scheme: dark)").matches;

const colours = {
    body: dark ? 0x8fb3d9 : 0x7fa6cf, edge: dark ? 0xdde6f0 : 0x24364a, space: dark ? 0x9aa4b0 : 0x6b7684,
    grid: dark ? 0x4a5462 : 0xc3cbd6, axes: dark ? 0xd8dee6 : 0x1d2a38, omega: 0xd55e00, momentum: dark ? 0x4da3ff : 0x0060b0,
    torque: 0xcc2f6f, trail: dark ? 0x3ddba5 : 0x008a63, polhode: dark ? 0xe3b341 : 0xb07a00,
};
const plotColours = {
    text: dark ? "#c9d1d9" : "#39424e", line: dark ? "#30363d" : "#e3e7ec", series: PANEL_COLOURS[dark ? "dark" : "light"],
};

function unpack(text, columns) {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const view = new DataView(bytes.buffer), rows = [];
    for (let k = 0; k < bytes.length/8; k += columns) {
        rows.push(Float64Array.from({length: columns}, (_, i) => view.getFloat64(8*(k + i), true)));
    }
    return rows;
}

const number = (value, digits = 4) => value === 0 ? "0" : Math.abs(value) < 1e-3 || Math.abs(value) >= 1e5
    ? Number(value.toPrecision(digits)).toExponential().replace("e+", "e") : String(Number(value.toPrecision(digits)));

const [CLOCK, CLOCK_UNIT] = [[86400, "days"], [3600, "h"], [1, "s"]].find(([size]) => data.stop - data.start >= (size > 1 ? 4*size : 0));
const PLACES = Math.min(Math.max(4, 4 + Math.ceil(Math.log10(Math.abs(data.stop)/(data.stop - data.start)))), 15);
const moment = (t) => `${number(t/CLOCK, PLACES)} ${CLOCK_UNIT}`;      // a time as text

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
    constructor() {
        this.constants = {...data.constants};
        this.omega = [...data.omega];
        this.quaternion = [...data.quaternion];
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

    /** Return the largest difference from symrot's own motion: of ω relative to its size, and of the quaternion. */
    agreement() {
        const at = unpack(data.reference.t, 1), states = unpack(data.reference.y, 7);
        const largest = Math.max(...states.map((y) => Math.hypot(y[0], y[1], y[2]))) || 1;
        let worst = 0;
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

/* --- the page ----------------------------------------------------------------------------------------------------- */

class Page {
    constructor() {
        this.model = new Model();
        this.drawing = this.#picture();
        this.t = data.start;
        this.playing = !REDUCED;
        this.stop = data.stop;
        this.fastest = Math.hypot(...data.omega);
        this.frames = 0;
        element("title").textContent = data.title;
        element("source").textContent = [data.source, data.drawn].filter(Boolean).join(". ");
        element("keys").textContent = KEYS;
        this.#layers();
        this.#controls();
        this.#sliders();
        this.#panels();
        this.recompute();
        this.setSpeed(this.#usualSpeed());
        const resize = () => {
            this.drawing.resize();
            for (const {panel} of this.panels) panel.resize();
        };
        new ResizeObserver(resize).observe(element("stage"));
        window.addEventListener("resize", resize);
        resize();
        requestAnimationFrame((now) => this.#frame(now));
    }

    /** The speed at which the body rotates about twice a second, or the whole span takes sixteen seconds. */
    #usualSpeed() {
        return Math.min(12/(this.fastest || 1), (data.stop - data.start)/16);
    }

    /** Return the picture; where the browser has no WebGL, a sentence takes its place, and plots and sliders still work. */
    #picture() {
        try {
            return new Drawing(element("canvas"), element("labels"), data, colours);
        } catch (error) {
            element("canvas").hidden = true;
            element("labels").textContent = "This browser has no WebGL, so the body is not drawn; the plots below show the motion.";
            return new Proxy({}, {get: () => () => undefined});
        }
    }

    #layers() {
        const layers = [
            ["space", "space axes x, y, z", true], ["axes", "body axes 1, 2, 3", true], ["omega", Drawing.ARROWS.omega.title, true],
            ["momentum", Drawing.ARROWS.momentum.title, true],
            ...(computed && data.hasTorque ? [["torque", Drawing.ARROWS.torque.title, true]] : []),
            ["trail", "path of the body's axis", true], ["polhode", "polhode (ω in the body)", data.free && !data.symmetric],
            ["herpolhode", "herpolhode (ω in space)", false],
        ];
        if (data.free) layers.push(["poinsot", "Poinsot's ellipsoid on its plane", false]);
        if (data.free && (data.symmetric || data.constants?.A !== undefined)) layers.push(["cones", "body and space cone, if two moments are equal", data.symmetric]);
        if (data.down) layers.push(["gravity", "direction of gravity g", true]);
        this.layers = layers;
        for (const [name, title, shown] of layers) {
            const label = document.createElement("label");
            label.innerHTML = `<input type="checkbox"> <span></span>`;
            label.querySelector("span").textContent = title;
            const box = label.querySelector("input");
            box.checked = shown;
            box.addEventListener("change", () => this.drawing.show(name, box.checked));
            element("layers").append(label);
            this.drawing.show(name, shown);
        }
    }

    #controls() {
        const play = element("play");
        play.addEventListener("click", () => this.toggle());
        element("restart").addEventListener("click", () => this.seek(data.start));
        element("scrub").addEventListener("input", (event) => this.seek(data.start + event.target.value/1000*(data.stop - data.start)));
        element("speed").addEventListener("input", (event) => this.setSpeed(this.#usualSpeed()*2**Number(event.target.value)));
        element("view").addEventListener("change", (event) => { this.drawing.follow = event.target.value === "body"; });
        document.addEventListener("keydown", (event) => {
            if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest?.("input[type=number], select")) return;
            if (event.key === " " && event.target.closest?.("button, summary, input[type=checkbox]")) return;
            const step = (data.stop - data.start)/200, speed = element("speed");
            const actions = {
                " ": () => this.toggle(), ArrowLeft: () => this.seek(this.t - step), ArrowRight: () => this.seek(this.t + step),
                Home: () => this.seek(data.start), b: () => this.#switchView(), f: () => document.documentElement.requestFullscreen?.(),
                ArrowUp: () => { speed.value = Number(speed.value) + 1; speed.dispatchEvent(new Event("input")); },
                ArrowDown: () => { speed.value = Number(speed.value) - 1; speed.dispatchEvent(new Event("input")); },
            };
            if (!actions[event.key] || event.target.matches?.("input[type=range]") && event.key.startsWith("Arrow")) return;
            event.preventDefault();
            actions[event.key]();
        });
        this.#showPlaying();
    }

    #switchView() {
        const view = element("view");
        view.value = view.value === "body" ? "space" : "body";
        view.dispatchEvent(new Event("change"));
    }

    setSpeed(speed) {
        this.speed = speed;
        element("speed-value").textContent = speed === 1 ? "as in reality" : speed > 1 ? `${number(speed, 3)} times faster` : `${number(1/speed, 3)} times slower`;
    }

    toggle() {
        if (!this.playing && this.t >= this.stop) this.t = data.start;
        this.playing = !this.playing;
        this.#showPlaying();
    }

    #showPlaying() {
        element("play").textContent = this.playing ? "Pause" : "Play";
        this.#describe();
    }

    seek(t) {
        this.t = Math.min(Math.max(t, data.start), this.stop);
        this.#pose();
        this.#describe();
    }

    #sliders() {
        const form = element("sliders");
        if (!computed) {
            element("change").hidden = true;
            element("played").textContent = `This page plays the motion: ${data.played}.`;
            return;
        }
        this.inputs = {};
        const groups = {rates: "Initial angular velocity", attitude: `Initial attitude, ${data.sequence}`, moments: "Moments of inertia", torque: "Torque"};
        const sets = {};
        const group = (key) => {
            if (sets[key]) return sets[key];
            const set = document.createElement("fieldset");
            set.innerHTML = "<legend></legend>";
            set.querySelector("legend").textContent = groups[key];
            form.append(set);
            return sets[key] = set;
        };
        const angles = new Float64Array(3);
        kernel.angles_of_quaternion(Float64Array.from(data.quaternion), angles);
        this.angles = [...angles];
        const rows = data.sliders.map((slider) => [slider, slider.name.startsWith("omega_") ? "rates" : MOMENTS.includes(slider.name) ? "moments" : "torque"]);
        const attitude = this.angles.map((value, k) => [{name: `angle_${k}`, label: "φθψ"[k], unit: "deg", value: value*180/Math.PI, low: -180, high: 180}, "attitude"]);
        for (const [{name, label, unit, value, low, high}, key] of [...rows.slice(0, 3), ...attitude, ...rows.slice(3)]) {
            const row = document.createElement("label");
            row.innerHTML = `<span></span><input type="range" min="0" max="1000" step="1"><input type="number" step="any">`;
            const [range, typed] = row.querySelectorAll("input");
            row.querySelector("span").textContent = unit && unit !== "1" ? `${label}, ${unit.replace("^2", "²")}` : label;
            range.setAttribute("aria-label", label);
            typed.setAttribute("aria-label", `${label}, typed`);
            const place = (current) => {
                range.value = 1000*(current - low)/(high - low);
                typed.value = Math.abs(current) < 1e-13*Math.max(Math.abs(low), Math.abs(high)) ? "0" : number(current, 5);
            };
            place(value);
            range.addEventListener("input", () => {
                typed.value = number(low + range.value/1000*(high - low), 5);
                this.change(name, Number(typed.value));
            });
            typed.addEventListener("change", () => {
                const wish = Number(typed.value);
                if (typed.value.trim() !== "" && Number.isFinite(wish) && (wish >= 0 || low < 0)) return this.change(name, wish);
                this.#place();
                element("warning").textContent = `${label}: expected ${low < 0 ? "a number" : "a number that is not negative"}.`;
            });
            this.inputs[name] = place;
            group(key).append(row);
        }
        element("reset").addEventListener("click", () => this.reset());
    }

    /** Put all sliders and fields to the present numbers of the model. */
    #place() {
        for (const [name, place] of Object.entries(this.inputs ?? {})) {
            const index = name.split("_")[1];
            const isAngle = /^angle_[0-2]$/.test(name), isRate = /^omega_[1-3]$/.test(name);
            place(isAngle ? this.angles[index]*180/Math.PI : isRate ? this.model.omega[index - 1] : this.model.constants[name]);
        }
    }

    reset() {
        Object.assign(this.model, {constants: {...data.constants}, omega: [...data.omega], quaternion: [...data.quaternion]});
        const angles = new Float64Array(3);
        kernel.angles_of_quaternion(Float64Array.from(data.quaternion), angles);
        this.angles = [...angles];
        this.recompute();
    }

    /** Give a constant or an initial value another number, and compute the motion again. */
    change(name, value) {
        const {model} = this, index = name.split("_")[1];
        if (/^omega_[1-3]$/.test(name)) model.omega[index - 1] = value;
        else if (/^angle_[0-2]$/.test(name)) {
            this.angles[index] = value*Math.PI/180;
            const q = new Float64Array(4);
            kernel.quaternion_of_angles(Float64Array.from(this.angles), q);
            model.quaternion = [...q];
        } else {
            const pair = MOMENTS.includes(name) ? MOMENTS.filter((other) => other !== name && data.constants[other] === data.constants[name]) : [];
            const moments = {...model.constants, [name]: value};
            if (pair.length === 1) moments[pair[0]] = value;      // the body of the scene is symmetric, and stays so
            const sorted = [moments.A, moments.B, moments.C].sort((a, b) => a - b);
            if (MOMENTS.includes(name) && !(sorted[0] > 0 && sorted[0] + sorted[1] >= sorted[2]*(1 - 1e-12))) {
                this.#place();
                element("warning").textContent = "No body has these moments: each must be positive, and none larger than the sum of the others.";
                return;
            }
            Object.assign(model.constants, moments);
        }
        this.recompute();
    }

    #panels() {
        const angleNames = ["φ", "θ", "ψ"];
        const up = data.down?.map((value) => -value);
        const about = up ? "the vertical" : data.free ? "the angular momentum" : "the z axis of space";
        const definitions = [
            {title: "Angular velocity in the body", unit: "rad/s", names: ["ω₁", "ω₂", "ω₃"], value: (state) => state.omegaBody},
        ];
        const angles = new Float64Array(3);
        definitions.push({title: `Euler angles ${data.sequence}`, unit: "deg", names: angleNames, value: (state) => {
            kernel.angles_of_quaternion(Float64Array.from(state.quaternion), angles);
            return Array.from(angles, (angle) => angle*180/Math.PI);
        }});
        definitions.push({title: `Angle of the ${data.axisName} to ${about}`, unit: "deg", names: ["angle"], value: (state) => {
            const reference = up ?? (data.free ? state.momentum : [0, 0, 1]), size = Math.hypot(...reference) || 1;
            const sine = Math.hypot(...cross(state.axis, reference))/size;
            return [Math.atan2(sine, dot(state.axis, reference)/size)*180/Math.PI];
        }});
        if (computed && data.conserved.length) {
            definitions.push({title: "Drift of conserved quantities, relative", unit: "", names: data.conserved.map(({name}) => name), value: (state) => this.drift(state)});
        } else {
            definitions.push({title: "Kinetic energy", unit: "J", names: ["energy"], value: (state) => [state.kinetic ?? state.energy]});
        }
        this.panels = definitions.map((definition) => ({
            ...definition, panel: new Panel(element("panels"), definition, plotColours, moment, (t) => this.seek(t)),
        }));
    }

    /** Return the change of each conserved quantity since the start, relative to its scale. */
    drift(state) {
        return state.conserved.map((value, k) => (value - this.first.conserved[k])/this.scales[k]);
    }

    recompute() {
        const {model, drawing} = this;
        const begun = performance.now();
        model.restart();
        model.motion.reach(data.stop);
        this.seconds = (performance.now() - begun)/1000;
        const reached = model.motion.t, span = reached - data.start;
        this.stop = reached;
        this.#place();
        element("warning").textContent = model.motion.failure ? `The motion ends early: ${model.motion.failure}.` : "";
        this.first = model.at(data.start);
        const momentum = Math.hypot(...this.first.momentum), energy = Math.max(Math.abs(this.first.energy), Math.abs(this.first.kinetic ?? 0));
        this.scales = data.conserved.map(({unit, output}, k) => (unit === "J" ? energy : unit === "kg m^2/s" ? momentum : 0) || Math.abs(this.first.conserved[k]) || 1);
        const points = [], count = Math.min(Math.max(Drawing.TRAIL, 4*model.motion.detail), Drawing.MOST), largest = {omega: 0, momentum: 0, torque: 0};
        for (let k = 0; k < count; ++k) {
            const state = model.at(data.start + span*k/(count - 1));
            for (const name of ["omega", "momentum", "torque"]) {
                largest[name] = Math.max(largest[name], state[name] ? Math.hypot(...state[name]) : 0);
            }
            points.push(state);
        }
        drawing.scales(largest);
        for (const name of ["whole", "trail"]) drawing.path(name, points.map(({axis}) => axis), Drawing.TIP);
        drawing.path("herpolhode", points.map(({omega}) => omega), Drawing.LONGEST/(largest.omega || 1));
        drawing.path("polhode", points.map(({omegaBody}) => omegaBody), Drawing.LONGEST/(largest.omega || 1));
        this.trailCount = points.length;
        this.fastest = largest.omega;
        if (data.free) {
            drawing.construction(momentum > 0 && {
                omega: this.first.omegaBody, momentum: this.first.momentum, energy: this.first.kinetic ?? this.first.energy,
                inertia: model.moments, axes: model.constants?.A === undefined ? data.axes : [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
                quaternion: this.first.quaternion, symmetryAxis: model.symmetryAxis,
            });
            for (const [name] of this.layers) if (["poinsot", "cones"].includes(name)) {
                const box = element("layers").querySelectorAll("input")[this.layers.findIndex(([other]) => other === name)];
                drawing.show(name, box.checked);
            }
        }
        for (const {panel, value} of this.panels) {
            panel.fill(sampled((t) => value(model.at(t)), data.start, reached, model.motion.detail));
        }
        const reshaped = computed && Object.keys(data.constants).some(
            (name) => /^([ABC]|center_of_mass_\d)$/.test(name) && model.constants[name] !== data.constants[name]);
        element("kept").textContent = reshaped ? "The picture keeps the body of the scene." : "";
        this.#trust();
        this.seek(Math.min(this.t, reached));
    }

    /** Say how the motion was computed, how much the conserved quantities drift, and how it agrees with symrot. */
    #trust() {
        const {model} = this, lines = [];
        if (!computed) {
            lines.push(`Between samples the motion is interpolated, and agrees with the motion that symrot computed to ${number(model.agreement(), 2)}.`);
        } else {
            const drifts = data.conserved.length ? this.panels.at(-1).panel.largest() : [];
            lines.push(`Computed in this page in ${model.motion.steps.length} steps of Dormand-Prince 8(5,3), ${number(1000*this.seconds, 2)} ms.`);
            if (drifts.length) lines.push(`Conserved: ${data.conserved.map(({name}) => name).join(", ")}; largest relative drift ${number(Math.max(...drifts), 2)}.`);
            this.agreement = model.isOriginal ? model.agreement() : null;
            if (this.agreement !== null) lines.push(`Agrees with the motion that symrot computed to ${number(this.agreement, 2)}.`);
        }
        element("trust").textContent = lines.join(" ");
    }

    #pose() {
        const state = this.model.at(Math.min(this.t, this.stop));
        this.state = state;
        this.drawing.pose(state);
        this.drawing.trailUpTo((this.t - data.start)/((this.stop - data.start) || 1), this.trailCount);
        element("time").textContent = `t = ${moment(this.t)}`;
        element("scrub").value = 1000*(this.t - data.start)/(data.stop - data.start);
        for (const {panel} of this.panels) panel.cursor(this.t);
    }

    /** Put what the picture shows into words, for screen readers; not while it plays. */
    #describe() {
        if (this.playing || !this.state) return;
        const {omegaBody, axis} = this.state;
        element("description").textContent = `At ${moment(this.t)}: angular velocity ${omegaBody.map((value) => number(value, 3)).join(", ")} rad/s in the body;`
            + ` the ${data.axisName} points to ${axis.map((value) => number(value, 2)).join(", ")} in space.`;
    }

    #frame(now) {
        const elapsed = Math.min((now - (this.before ?? now))/1000, 0.1);
        this.before = now;
        if (this.playing) {
            this.t += elapsed*this.speed;
            if (this.t >= this.stop) {
                this.t = this.stop;
                this.playing = false;
                this.#showPlaying();
            }
            this.#pose();
        }
        this.drawing.render();
        this.frames += 1;
        requestAnimationFrame((next) => this.#frame(next));
    }
}

window.symrot = new Page();
