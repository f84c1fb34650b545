/* The page: it computes the motion, lets people play and change it, and says how far it can be trusted. */

const KEYS = "space: play or pause; left, right: step; home, end: start, end; up, down: faster, slower; b: view from the body;"
    + " shift with arrows: rotate the view; +, -: zoom; f: full screen";
const REDUCED = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
const DARK = window.matchMedia("(prefers-color-scheme: dark)");
const SLICE = 10, FIRST_SLICE = 100;     // ms: how long a motion is computed before the next frame; the first motion
const TOLD_AFTER = 4;             // frames between two texts of the time, where the processor draws the page
const STEPS_AT_ONCE = 16, SAMPLES_AT_ONCE = 64;
const LONGEST_RUN = 500;          // ms: a computation that has run longer is given up when the reader asks for another motion
const TURN = Math.PI/24;          // rad: rotation of the view by a key

const data = JSON.parse(document.getElementById("data").textContent);
const computed = !data.played;      // whether the page computes the motion, or plays samples of it
const element = (id) => document.getElementById(id);

const PALETTES = {
    light: {
        drawing: {body: 0x7fa6cf, edge: 0x24364a, space: 0x6b7684, grid: 0xc3cbd6, axes: 0x1d2a38, omega: 0xc24f00, momentum: 0x0060b0, torque: 0xb81f62, trail: 0x008a63, polhode: 0xb07a00},
        plots: {text: "#39424e", line: "#e3e7ec", series: ["#0072B2", "#c24f00", "#008a63", "#9b4f8a"]},
    },
    dark: {
        drawing: {body: 0x8fb3d9, edge: 0xdde6f0, space: 0x9aa4b0, grid: 0x4a5462, axes: 0xd8dee6, omega: 0xff9b54, momentum: 0x4da3ff, torque: 0xff7ab0, trail: 0x3ddba5, polhode: 0xe3b341},
        plots: {text: "#c9d1d9", line: "#30363d", series: ["#56B4E9", "#ff9b54", "#3ddba5", "#e39ccb"]},
    },
};
const palette = () => PALETTES[DARK.matches && !window.matchMedia("print").matches ? "dark" : "light"];
const plotColours = {...palette().plots};

const number = (value, digits = 4) => value === 0 ? "0" : Math.abs(value) < 1e-3 || Math.abs(value) >= 1e5
    ? Number(value.toPrecision(digits)).toExponential().replace("e+", "e") : String(Number(value.toPrecision(digits)));

const SPAN = data.stop - data.start;
const CLOCKS = [[86400, "days", 4*86400], [3600, "h", 4*3600], [1, "s", 0.05], [1e-3, "ms", 5e-5], [1e-6, "µs", 0]];      // size, s; name; least span
const CLOCK = CLOCKS.find(([, , least]) => SPAN >= least);
const PLACES = Math.min(Math.max(0, Math.ceil(-Math.log10(SPAN/CLOCK[0]/2000))), 15);
const moment = (t) => `${(t/CLOCK[0]).toFixed(PLACES)} ${CLOCK[1]}`;      // a time as text

/* --- the page ----------------------------------------------------------------------------------------------------- */

class Page {
    constructor() {
        this.model = new Model();
        this.wish = this.model;          // the motion that the reader has asked for; it is shown when it is computed
        this.drawing = this.#picture();
        this.t = data.start;
        this.playing = !REDUCED;
        this.stop = data.start;          // how far the motion is computed
        this.fastest = Math.hypot(...data.omega);
        this.frames = 0;
        element("source").textContent = [data.source, data.drawn].filter(Boolean).join(". ");
        element("keys").textContent = KEYS;
        this.#layers();
        this.#controls();
        this.#sliders();
        this.#panels();
        this.setSpeed(this.#usualSpeed());
        this.recompute();
        this.#advance(FIRST_SLICE);
        this.#pose();
        const resize = () => {
            this.drawing.resize();
            for (const {panel} of this.panels) panel.resize();
        };
        new ResizeObserver(resize).observe(element("stage"));
        window.addEventListener("resize", resize);
        for (const media of [DARK, window.matchMedia("print")]) media.addEventListener("change", () => this.#recolour());
        window.addEventListener("beforeprint", () => this.#print());
        window.addEventListener("afterprint", () => {
            this.#recolour();
            this.drawing.resize();
        });
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
            return new Drawing(element("canvas"), element("labels"), data, palette().drawing);
        } catch (error) {
            element("canvas").hidden = true;
            element("labels").textContent = "This browser has no WebGL, so the body is not drawn; the plots below show the motion.";
            return new Proxy({}, {get: () => () => undefined});
        }
    }

    /** Use the colours of light or dark, or those of paper. */
    #recolour() {
        Object.assign(plotColours, palette().plots);
        this.drawing.recolour(palette().drawing);
        this.#construct();
        this.drawing.render();
        for (const {panel} of this.panels) {
            panel.resize();
            panel.redraw();
        }
    }

    #layers() {
        const layers = [
            ["space", "space axes x, y, z", true], ["axes", "body axes 1, 2, 3", true], ["omega", Drawing.ARROWS.omega.title, true],
            ["momentum", Drawing.ARROWS.momentum.title, true],
            ...(computed && data.hasTorque ? [["torque", Drawing.ARROWS.torque.title, true]] : []),
            ["trail", `path of the ${data.axisName}`, true], ["polhode", "polhode (ω in the body)", data.free && !data.symmetric],
            ["herpolhode", "herpolhode (ω in space)", false],
        ];
        if (data.free) layers.push(["poinsot", "Poinsot's ellipsoid on its plane", false]);
        if (data.free && (data.symmetric || data.constants?.A !== undefined)) layers.push(["cones", "body and space cone, if two moments are equal", data.symmetric]);
        if (data.orbit) layers.push(["vertical", "local vertical, toward the planet", true]);
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
        element("scrub").addEventListener("input", (event) => this.seek(data.start + event.target.value/1000*(this.stop - data.start)));
        element("speed").addEventListener("input", (event) => this.setSpeed(this.#usualSpeed()*2**Number(event.target.value)));
        element("view").addEventListener("change", (event) => {
            this.drawing.follow = event.target.value;
            this.#pose();
        });
        if (data.orbit) {
            const option = document.createElement("option");
            option.value = "vertical";
            option.textContent = "with the local vertical";
            element("view").append(option);
        }
        document.addEventListener("keydown", (event) => {
            if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest?.("input[type=number], select")) return;
            if (event.key === " " && event.target.closest?.("button, summary, input[type=checkbox]")) return;
            const step = (this.stop - data.start)/200, speed = element("speed"), turn = (...by) => () => this.drawing.turn(...by);
            const actions = event.shiftKey && event.key.startsWith("Arrow") ? {
                ArrowLeft: turn(-TURN, 0, 1), ArrowRight: turn(TURN, 0, 1), ArrowUp: turn(0, TURN, 1), ArrowDown: turn(0, -TURN, 1),
            } : {
                "+": turn(0, 0, 1/1.1), "=": turn(0, 0, 1/1.1), "-": turn(0, 0, 1.1), End: () => this.seek(this.stop),
                " ": () => this.toggle(), ArrowLeft: () => this.seek(this.t - step), ArrowRight: () => this.seek(this.t + step),
                Home: () => this.seek(data.start), b: () => this.#switchView(), f: () => document.documentElement.requestFullscreen?.(),
                ArrowUp: () => { speed.value = Number(speed.value) + 1; speed.dispatchEvent(new Event("input")); },
                ArrowDown: () => { speed.value = Number(speed.value) - 1; speed.dispatchEvent(new Event("input")); },
            };
            if (!actions[event.key] || event.target.matches?.("input[type=range]") && /^(Arrow|Home|End)/.test(event.key)) return;
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
        element("speed").setAttribute("aria-valuetext", element("speed-value").textContent);
    }

    toggle() {
        if (!this.playing && this.t >= this.stop) this.t = data.start;
        this.playing = !this.playing;
        this.#showPlaying();
    }

    /** Play the motion from its start. */
    restart() {
        this.seek(data.start);
        this.playing = true;
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
            row.classList.toggle("long", label.length > 12);
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
            place(isAngle ? this.angles[index]*180/Math.PI : isRate ? this.wish.omega[index - 1] : this.wish.constants[name]);
        }
    }

    reset() {
        const angles = new Float64Array(3);
        kernel.angles_of_quaternion(Float64Array.from(data.quaternion), angles);
        this.angles = [...angles];
        this.wish = new Model();
        this.recompute();
    }

    /** Give a constant or an initial value another number, and compute the motion again. */
    change(name, value) {
        const index = name.split("_")[1], numbers = {constants: {...this.wish.constants}, omega: [...this.wish.omega], quaternion: this.wish.quaternion};
        let remark = "";
        if (/^omega_[1-3]$/.test(name)) numbers.omega[index - 1] = value;
        else if (/^angle_[0-2]$/.test(name)) {
            this.angles[index] = value*Math.PI/180;
            const q = new Float64Array(4);
            kernel.quaternion_of_angles(Float64Array.from(this.angles), q);
            numbers.quaternion = [...q];
        } else if (MOMENTS.includes(name)) {
            const others = MOMENTS.filter((other) => other !== name), {constants} = numbers;
            const pair = others.filter((other) => data.constants[other] === data.constants[name]);      // a symmetric body stays so
            const [a, b] = others.map((other) => constants[other]), third = constants[others.find((other) => !pair.includes(other))];
            const low = pair.length === 2 ? 0 : pair.length === 1 ? third/2 : Math.abs(a - b), high = pair.length ? Infinity : a + b;
            const possible = Math.min(Math.max(value, low), high);
            if (!(possible > 0)) remark = `${name}: expected a positive moment of inertia.`;
            else if (possible !== value) remark = `${name} = ${number(possible, 5)} kg m²: no moment of a body is larger than the sum of the other two.`;
            for (const other of possible > 0 ? [name, ...pair] : []) constants[other] = possible;
        } else numbers.constants[name] = value;
        this.wish = new Model(numbers);
        this.recompute(remark);
    }

    #panels() {
        const isIntrinsic = data.sequence === data.sequence.toUpperCase();
        const angleNames = ["φ", "θ", "ψ"].map((letter, k) => `${letter} about ${data.sequence[k]}`);
        const up = data.down?.map((value) => -value);
        const about = up ? "the vertical" : data.free ? "the angular momentum" : "the z axis of space";
        const definitions = [
            {title: "Angular velocity in the body,", unit: "rad/s", names: ["ω₁", "ω₂", "ω₃"], value: (state) => state.omegaBody},
        ];
        const angles = new Float64Array(3);
        definitions.push({title: `Euler angles ${data.sequence}, ${isIntrinsic ? "intrinsic" : "extrinsic"},`, unit: "deg", kind: "angle", names: angleNames, value: (state) => {
            kernel.angles_of_quaternion(Float64Array.from(state.quaternion), angles);
            return Array.from(angles, (angle) => angle*180/Math.PI);
        }});
        if (data.orbit) {
            definitions.push({title: "Long axis from the local vertical,", unit: "deg", kind: "angle", names: ["in the orbit plane", "out of it", "in all"], value: (state) => this.#libration(state)});
        } else definitions.push({title: `Angle of the ${data.axisName} to ${about},`, unit: "deg", kind: "angle", names: ["angle"], value: (state) => {
            const reference = up ?? (data.free ? state.momentum : [0, 0, 1]), size = Math.hypot(...reference) || 1;
            const sine = Math.hypot(...cross(state.axis, reference))/size;
            return [Math.atan2(sine, dot(state.axis, reference)/size)*180/Math.PI];
        }});
        if (computed && data.conserved.length) {
            definitions.push({title: "Largest drift of conserved quantities so far, relative", unit: "", kind: "drift", names: data.conserved.map(({name}) => name), value: (state, start) => this.#drift(state, start)});
        } else {
            definitions.push({title: "Kinetic energy,", unit: "J", names: ["energy"], value: (state) => [state.kinetic ?? state.energy]});
        }
        this.panels = definitions.map((definition) => ({
            ...definition, panel: new Panel(element("panels"), definition, plotColours, CLOCK, (t) => this.seek(t)),
        }));
    }

    /** Return the angles of a satellite's long axis to the local vertical, deg: in the plane of the orbit, out of it, in all. */
    #libration({quaternion, vertical}) {
        const line = rotate(quaternion, data.orbit.axis).map((value) => value*this.longAxisSign);
        const along = cross([0, 0, 1], vertical), ahead = dot(line, along), up = dot(line, vertical);
        return [Math.atan2(ahead, up), Math.atan2(line[2], Math.hypot(ahead, up)), Math.atan2(Math.hypot(...cross(line, vertical)), up)]
            .map((angle) => angle*180/Math.PI);
    }

    /** Return the change of each conserved quantity since the start, relative to its scale. */
    #drift(state, {first, scales}) {
        return state.conserved.map((value, k) => (value - first.conserved[k])/scales[k]);
    }

    /** Compute the wished motion, in slices between frames; until it is there, the page shows the last one. */
    recompute(remark = "") {
        this.remark = remark;
        this.#place();
        if (this.job && performance.now() - this.job.begun < LONGEST_RUN) return;      // its end begins the next one
        this.#begin();
    }

    #begin() {
        const model = this.wish;
        this.job = {model, begun: performance.now(), seconds: 0, work: this.#work(model)};
    }

    /** Work on the wished motion for a while, ms. */
    #advance(budget) {
        const {job} = this, begun = performance.now();
        if (!job) return;
        let step;
        do step = job.work.next();
        while (!step.done && performance.now() - begun < budget);
        job.seconds += (performance.now() - begun)/1000;
        const part = step.value;
        element("progress").textContent = !step.done && performance.now() - job.begun > 300 ? `Computing the motion: ${Math.round(100*part)} %` : "";
        if (!step.done) return;
        this.job = null;
        if (job.model !== this.wish) this.#begin();
        this.#showResult(job, step.value);
    }

    /** Prepare the page for a printer: compute what is left of the motion, and put a still picture in place of the moving one. */
    #print() {
        while (this.job) this.#advance(Infinity);
        this.drawing.recolour(PALETTES.light.drawing);
        this.#construct();
        this.drawing.render();
        const still = element("still");
        still.src = element("canvas").toDataURL();
        element("stage").style.setProperty("--ratio", this.drawing.ratio);
        this.drawing.pinInPercent();
    }

    /** Compute a motion and all that is drawn of it, in pieces; yields the part that is done, 0 to 1. */
    *#work(model) {
        const begun = performance.now(), {motion} = model, whole = data.stop - data.start;
        while (motion.t < data.stop && !motion.failure) {
            motion.reach(data.stop, STEPS_AT_ONCE);
            yield 0.5*(motion.t - data.start)/whole;
        }
        const reached = motion.t, first = model.at(data.start);
        const momentum = Math.hypot(...first.momentum), energy = Math.max(Math.abs(first.energy), Math.abs(first.kinetic ?? 0));
        const scales = data.conserved.map(({unit}, k) => (unit === "J" ? energy : unit === "kg m^2/s" ? momentum : 0) || Math.abs(first.conserved[k]) || 1);
        if (data.orbit) this.longAxisSign = dot(rotate(first.quaternion, data.orbit.axis), first.vertical) < 0 ? -1 : 1;
        const count = Math.min(Math.max(Drawing.TRAIL, motion.detail), Drawing.MOST), largest = {omega: 0, momentum: 0, torque: 0};
        const paths = {axis: new Float32Array(3*count), omega: new Float32Array(3*count), omegaBody: new Float32Array(3*count)};
        for (let k = 0; k < count; ++k) {
            const state = model.at(data.start + (reached - data.start)*k/(count - 1));
            for (const name of ["omega", "momentum", "torque"]) {
                largest[name] = Math.max(largest[name], state[name] ? Math.hypot(...state[name]) : 0);
            }
            for (const name of ["axis", "omega", "omegaBody"]) paths[name].set(state[name], 3*k);
            if (k % SAMPLES_AT_ONCE === 0) yield 0.5 + 0.25*k/count;
        }
        const times = sampleTimes(data.start, reached, motion.detail);
        const columns = this.panels.map(({names}) => names.map(() => new Float64Array(times.length)));
        for (let k = 0; k < times.length; ++k) {
            const state = model.at(times[k]);
            this.panels.forEach(({value}, i) => value(state, {first, scales}).forEach((entry, j) => { columns[i][j][k] = entry; }));
            if (k % SAMPLES_AT_ONCE === 0) yield 0.75 + 0.25*k/times.length;
        }
        return {first, largest, paths, times, columns, reached};
    }

    #showResult({model, seconds}, {first, largest, paths, times, columns, reached}) {
        const {drawing} = this, unit = Drawing.LONGEST/(largest.omega || 1);
        Object.assign(this, {model, first, seconds, stop: reached, trailCount: times.length ? paths.axis.length/3 : 0, fastest: largest.omega});
        const ending = model.motion.failure ? `The motion ends early: ${model.motion.failure}.` : "";
        element("warning").textContent = [this.remark, ending].filter(Boolean).join(" ");
        drawing.scales(largest);
        for (const name of ["whole", "trail"]) drawing.path(name, paths.axis, Drawing.TIP);
        drawing.path("herpolhode", paths.omega, unit);
        drawing.path("polhode", paths.omegaBody, unit);
        this.#construct();
        const stretch = model.stretch;
        drawing.stretch(stretch);
        element("kept").textContent = stretch.note;
        this.panels.forEach(({panel}, i) => panel.fill(times, columns[i]));
        this.#trust();
        this.seek(Math.min(this.t, reached));
    }

    /** Draw Poinsot's ellipsoid and the cones of the present motion. */
    #construct() {
        const {model, drawing, first} = this;
        if (!data.free || !first) return;
        drawing.construction(Math.hypot(...first.momentum) > 0 && {
            omega: first.omegaBody, momentum: first.momentum, energy: first.kinetic ?? first.energy,
            inertia: model.moments, axes: model.constants?.A === undefined ? data.axes : [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
            quaternion: first.quaternion, symmetryAxis: model.symmetryAxis,
        });
        for (const [name] of this.layers) if (["poinsot", "cones"].includes(name)) {
            const box = element("layers").querySelectorAll("input")[this.layers.findIndex(([other]) => other === name)];
            drawing.show(name, box.checked);
        }
    }

    /** Say how the motion was computed, how much the conserved quantities drift, and how it agrees with symrot. */
    #trust() {
        const {model} = this, lines = [];
        if (!computed) {
            lines.push(`Between samples the motion is interpolated, and agrees with the motion that symrot computed to ${number(model.agreement(), 2)}.`);
        } else {
            const drifts = data.conserved.length ? this.panels.at(-1).panel.largest() : [];
            lines.push(`Computed in this page in ${model.motion.steps.length} steps of Dormand-Prince 8(5,3), ${number(1000*this.seconds, 2)} ms.`);
            if (drifts.length) lines.push(`Conserved: ${data.conserved.map(({name}) => name).join(", ")}; ${drifts.every(Number.isFinite) ? `largest relative drift ${number(Math.max(...drifts), 2)}` : "but their drift has no number"}.`);
            this.agreement = model.isOriginal ? model.agreement() : null;
            if (this.agreement !== null) lines.push(`Agrees with the motion that symrot computed to ${number(this.agreement, 2)}.`);
        }
        element("trust").textContent = lines.join(" ");
    }

    /** Show the present time in the picture, and, if `everywhere`, beside it and in the plots. */
    #pose(everywhere = true) {
        const state = this.model.at(Math.min(this.t, this.stop));
        this.state = state;
        this.drawing.pose(state);
        this.drawing.trailUpTo((this.t - data.start)/((this.stop - data.start) || 1), this.trailCount);
        if (!everywhere) return;
        const time = `t = ${moment(this.t)}`;
        if (element("time").textContent !== time) element("time").textContent = time;
        element("scrub").value = 1000*(this.t - data.start)/(this.stop - data.start || 1);
        if (!this.playing) element("scrub").setAttribute("aria-valuetext", time);
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
        this.#advance(this.first ? SLICE : FIRST_SLICE);
        if (this.playing && this.first) {
            this.t += elapsed*this.speed;
            if (this.t >= this.stop) {
                this.t = this.stop;
                this.playing = false;
                this.#showPlaying();
            }
            this.#pose(!this.playing || !this.drawing.isSoftware || this.frames % TOLD_AFTER === 0);
        }
        this.drawing.render(this.playing);
        this.frames += 1;
        requestAnimationFrame((next) => this.#frame(next));
    }
}

// the text of the page is painted first
requestAnimationFrame(() => setTimeout(() => { window.symrot = new Page(); }));
