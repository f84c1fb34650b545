/* The three-dimensional picture: body, axes, vectors, paths, Poinsot's ellipsoid on its plane, and cones. */

const ARROWS = {
    omega: {label: "ω", title: "angular velocity ω"},
    momentum: {label: "L", title: "angular momentum L"},
    torque: {label: "M", title: "torque M"},
};
const LONGEST = 1.5;      // length of the longest ω, L or M, relative to the body
const TIP = 1.3;          // distance of the tip of the body's axis from the point of rotation
const TRAIL = 2000;       // fewest points of a path
const MOST = 20000;       // most points of a path
const THIN = 1.3, THICK = 2;      // pixels: lines of axes and of the path to come; of paths
const SHAFT = 0.012;      // radius of an arrow's shaft
const APART = 17;         // pixels between the middles of two labels

export class Drawing {
    constructor(canvas, labels, data, colours) {
        const {WebGLRenderer, Scene, PerspectiveCamera, OrbitControls, HemisphereLight, DirectionalLight, Group} = libraries;
        this.data = data;
        this.canvas = canvas;
        this.labels = labels;
        this.isSoftware = Drawing.#isSoftware();
        this.renderer = new WebGLRenderer({canvas, antialias: !this.isSoftware, alpha: true});
        this.scene = new Scene();
        this.camera = new PerspectiveCamera(35, 1, 0.05, 100);
        this.camera.up.set(0, 0, 1);
        this.camera.position.set(4.3, -5.6, 2.9);
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.enableDamping = true;
        this.controls.minDistance = 1.5;
        this.controls.maxDistance = 30;
        this.scene.add(new HemisphereLight(0xffffff, 0x8890a0, 2.2));
        const sun = new DirectionalLight(0xffffff, 2);
        sun.position.set(3, -4, 6);
        this.scene.add(sun);
        this.world = new Group();      // everything in space axes; it is rotated when the view follows the body
        this.body = new Group();       // everything in body axes
        this.world.add(this.body);
        this.scene.add(this.world);
        this.follow = "space";         // what stands still in the picture: space, the body, or the vertical of an orbit
        this.tinted = [];              // materials and labels with the names of their colours
        this.isStale = true;           // whether anything has changed since the last frame was drawn
        this.pins = [];                // text labels and the points to which they belong
        this.parts = {};
        this.colours = colours;
        this.#addBody();
        this.#addAxes();
        this.#addArrows();
        this.#addPaths();
        this.#addGround();
        this.#addGravity();
        this.#addVertical();
    }

    /** Return whether WebGL runs on the processor: moving pictures are then drawn without smooth edges, still ones in twice the size. */
    static #isSoftware() {
        const gl = document.createElement("canvas").getContext("webgl2"), info = gl?.getExtension("WEBGL_debug_renderer_info");
        const name = String(gl?.getParameter(info?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER));
        gl?.getExtension("WEBGL_lose_context")?.loseContext();
        return /SwiftShader|llvmpipe|softpipe|Software|Basic Render/i.test(name);
    }

    /** Give a material a colour of the palette by its name, and keep both, so that the palette can change. */
    #tint(material, name) {
        material.color.setHex(this.colours[name]);
        this.tinted.push((colours) => material.color.setHex(colours[name]));
        return material;
    }

    /** Draw everything in the colours of another palette. */
    recolour(colours) {
        this.colours = colours;
        for (const tint of this.tinted) tint(colours);
        this.isStale = true;
    }

    #addBody() {
        const {Mesh, MeshStandardMaterial, DoubleSide, BufferGeometry, BufferAttribute, SphereGeometry, TubeGeometry,
            CatmullRomCurve3, Vector3, EdgesGeometry, LineSegments, LineBasicMaterial, Group} = libraries;
        const shape = new Group();
        this.solid = this.#tint(new MeshStandardMaterial({
            side: DoubleSide, roughness: 0.55, metalness: 0.15, vertexColors: true,
            transparent: true, opacity: 1,
        }), "body");
        this.hasHoles = this.data.patches.some((patch) => patch.hole);
        this.solid.opacity = this.#opacity(false);
        const hole = new MeshStandardMaterial({
            color: 0x101820, side: DoubleSide, transparent: true, opacity: 0.45, polygonOffset: true,
            polygonOffsetFactor: -2, polygonOffsetUnits: -2,
        });
        const edge = this.#tint(new LineBasicMaterial(), "edge");
        const surfaces = [false, true].map((isHole) => ({isHole, points: [], shade: [], index: []}));      // each is drawn at once
        this.data.patches.forEach((patch, number) => {
            const points = Float32Array.from(patch.points), count = points.length/3;
            if (patch.columns === 0) {
                for (let k = 0; k < count; ++k) {
                    const ball = new Mesh(new SphereGeometry(0.06, 24, 16), this.solid);
                    ball.geometry.setAttribute("color", new BufferAttribute(
                        new Float32Array(ball.geometry.attributes.position.count*3).fill(1), 3));
                    ball.position.fromArray(points, 3*k);
                    shape.add(ball);
                }
                return;
            }
            if (patch.rows === 1) {
                const path = new CatmullRomCurve3(
                    Array.from({length: count}, (_, k) => new Vector3().fromArray(points, 3*k)), false, "catmullrom", 0);
                const tube = new TubeGeometry(path, Math.max(8, 2*count), 0.02, 12);
                tube.setAttribute("color", new BufferAttribute(
                    new Float32Array(tube.attributes.position.count*3).fill(1), 3));
                shape.add(new Mesh(tube, this.solid));
                return;
            }
            const {points: all, index, shade} = surfaces[patch.hole ? 1 : 0], before = all.length/3;
            for (let k = 0; k < points.length; ++k) all.push(points[k]);
            for (let i = 0; patch.mesh && i < count; ++i) {
                const first = 9*Math.floor(i/3);                        // the quadrant of the triangle's centre
                const x = points[first] + points[first + 3] + points[first + 6];
                const y = points[first + 1] + points[first + 4] + points[first + 7];
                const tone = x*y < 0 ? 0.72 : 1;
                shade.push(tone, tone, tone);
                index.push(before + i);
            }
            for (let i = 0; !patch.mesh && i < patch.rows; ++i) {
                for (let j = 0; j < patch.columns; ++j) {
                    const turning = patch.columns > 2 ? j/(patch.columns - 1) : patch.rows > 2 ? i/(patch.rows - 1) : number/6;
                    const tone = Math.floor(4*turning + 1e-9) % 2 ? 0.72 : 1;    // quarters, so that a spin can be seen
                    shade.push(tone, tone, tone);
                    if (i + 1 === patch.rows || j + 1 === patch.columns) continue;
                    const a = before + i*patch.columns + j, b = a + 1, c = a + patch.columns, d = c + 1;
                    index.push(a, b, c, b, d, c);
                }
            }
        });
        for (const {isHole, points, shade, index} of surfaces) {
            if (!index.length) continue;
            const geometry = new BufferGeometry();
            geometry.setAttribute("position", new BufferAttribute(Float32Array.from(points), 3));
            geometry.setAttribute("color", new BufferAttribute(Float32Array.from(shade), 3));
            geometry.setIndex(index);
            geometry.computeVertexNormals();
            shape.add(new Mesh(geometry, isHole ? hole : this.solid));
            shape.add(new LineSegments(new EdgesGeometry(geometry, 30), edge));
        }
        shape.matrixAutoUpdate = false;
        this.body.add(shape);
        this.parts.body = [shape];
        this.shape = shape;
        this.corners = this.data.patches.flatMap(({points}) => points);
    }

    /** Stretch the drawn body, see Model.stretch; a body that grows much is drawn smaller. */
    stretch({factors, from, to}) {
        const {size} = this.data, offset = to.map((value, k) => (value - factors[k]*from[k])/size);
        let largest = 0;
        for (let k = 0; k < this.corners.length; k += 3) {
            largest = Math.max(largest, Math.hypot(...[0, 1, 2].map((i) => factors[i]*this.corners[k + i] + offset[i])));
        }
        const zoom = Math.min(1, 1.4/(largest || 1)), [a, b, c] = factors.map((factor) => zoom*factor);
        const [x, y, z] = offset.map((value) => zoom*value);
        this.shape.matrix.set(a, 0, 0, x, 0, b, 0, y, 0, 0, c, z, 0, 0, 0, 1);
        this.shape.matrixWorldNeedsUpdate = true;
        if (this.stem) this.stem.geometry.setFromPoints([new libraries.Vector3(), new libraries.Vector3(...to).multiplyScalar(zoom/size)]);
        this.isStale = true;
    }

    /** A body is translucent if it has holes, or if Poinsot's ellipsoid is drawn around it. */
    #opacity(inside) {
        return inside ? 0.35 : this.hasHoles ? 0.6 : 1;
    }

    #addAxes() {
        const space = this.#axes(1.9, "space", ["x", "y", "z"], this.world);
        const axes = this.#axes(1.55, "axes", ["1", "2", "3"], this.body);
        this.parts.space = [space];
        this.parts.axes = [axes];
    }

    #axes(length, colour, names, parent) {
        const {Group, LineSegments2, LineSegmentsGeometry, LineMaterial, Vector3} = libraries;
        const group = new Group(), points = [];
        names.forEach((name, k) => {
            const end = new Vector3().setComponent(k, length);
            points.push(0, 0, 0, ...end.toArray());
            this.#pin(name, colour, () => group.visible ? group.localToWorld(end.clone().multiplyScalar(1.06)) : null);
        });
        group.add(new LineSegments2(new LineSegmentsGeometry().setPositions(points), this.#tint(new LineMaterial({linewidth: THIN}), colour)));
        parent.add(group);
        return group;
    }

    /** Add a label in a colour of the palette; its place is computed for each picture, and null where it is hidden. */
    #pin(text, colour, place) {
        const element = document.createElement("span");
        element.textContent = text;
        const tint = (colours) => { element.style.color = `#${colours[colour].toString(16).padStart(6, "0")}`; };
        tint(this.colours);
        this.tinted.push(tint);
        this.labels.append(element);
        this.pins.push({element, place});
    }

    /** Return an arrow of length 1 along its own y axis: a group with the shaft and the head. */
    #arrow(colour) {
        const {Group, Mesh, CylinderGeometry, ConeGeometry, MeshBasicMaterial} = libraries, arrow = new Group();
        const material = this.#tint(new MeshBasicMaterial(), colour);
        arrow.add(new Mesh(new CylinderGeometry(SHAFT, SHAFT, 1, 12), material), new Mesh(new ConeGeometry(1, 1, 24), material));
        return arrow;
    }

    /** Let an arrow point along a vector, with its length. */
    static #aim(arrow, vector) {
        const length = vector.length(), head = Math.min(0.17, 0.4*length), [shaft, cone] = arrow.children;
        arrow.quaternion.setFromUnitVectors(new libraries.Vector3(0, 1, 0), vector.clone().normalize());
        shaft.scale.set(1, length - head, 1);
        shaft.position.y = (length - head)/2;
        cone.scale.set(0.3*head, head, 0.3*head);
        cone.position.y = length - head/2;
    }

    #addArrows() {
        const {Vector3, Group} = libraries;
        this.arrows = {};
        for (const [name, {label}] of Object.entries(ARROWS)) {
            const arrow = this.#arrow(name);
            const group = new Group();
            group.add(arrow);
            this.world.add(group);
            this.arrows[name] = {arrow, group, vector: new Vector3(), size: 1};
            this.parts[name] = [group];
            this.#pin(label, name, () => {
                const {vector} = this.arrows[name];
                return group.visible && arrow.visible ? group.localToWorld(vector.clone().multiplyScalar(1.08)) : null;
            });
        }
    }

    #addPaths() {
        const {Line, Line2, LineMaterial, LineBasicMaterial, Group} = libraries;
        const line = (colour, parent, name, opacity = 1) => {
            const look = {opacity, transparent: opacity < 1};      // a processor draws thick lines too slowly
            const path = this.isSoftware ? new Line(undefined, this.#tint(new LineBasicMaterial(look), colour))
                : new Line2(undefined, this.#tint(new LineMaterial({linewidth: opacity < 1 ? THIN : THICK, ...look}), colour));
            path.frustumCulled = false;
            path.visible = false;      // until it has points
            const group = new Group();
            group.add(path);
            parent.add(group);
            this.parts[name] = [...(this.parts[name] ?? []), group];
            return path;
        };
        this.paths = {
            whole: line("trail", this.world, "trail", this.isSoftware ? 0.6 : 0.35),
            trail: line("trail", this.world, "trail"),
            herpolhode: line("omega", this.world, "herpolhode"),
            polhode: line("polhode", this.body, "polhode"),
        };
    }

    #addGround() {
        const {Mesh, ConeGeometry, MeshStandardMaterial, GridHelper, SphereGeometry, Group, Line, BufferGeometry,
            LineBasicMaterial, Vector3} = libraries;
        if (!this.data.fixedPoint) return;
        const ground = new Group(), down = new Vector3(...(this.data.down ?? [0, 0, -1]));
        ground.quaternion.setFromUnitVectors(new Vector3(0, 0, -1), down);
        const grid = new GridHelper(6, 12, this.colours.space, this.colours.grid);
        grid.rotation.x = Math.PI/2;
        grid.position.z = -0.6;
        const stand = new Mesh(new ConeGeometry(0.18, 0.6, 40), this.#tint(new MeshStandardMaterial(), "grid"));
        stand.rotation.x = Math.PI/2;
        stand.position.z = -0.3;
        ground.add(grid, stand, new Mesh(new SphereGeometry(0.035), this.#tint(new MeshStandardMaterial(), "edge")));
        this.world.add(ground);
        const {center, size} = this.data;
        if (center && !this.data.drawn.includes("proportions")) {
            const ends = [new Vector3(), new Vector3(...center).divideScalar(size)];
            this.stem = new Line(new BufferGeometry().setFromPoints(ends), this.#tint(new LineBasicMaterial(), "edge"));
            this.body.add(this.stem);
        }
    }

    #addGravity() {
        if (!this.data.down) return;
        const {Vector3, Group} = libraries, down = new Vector3(...this.data.down), group = new Group();
        const start = down.clone().multiplyScalar(-0.5).add(new Vector3(-1.6, 0.6, 0));
        const arrow = this.#arrow("space");
        arrow.position.copy(start);
        Drawing.#aim(arrow, down.clone().multiplyScalar(0.8));
        group.add(arrow);
        this.world.add(group);
        this.parts.gravity = [group];
        const end = start.clone().addScaledVector(down, 0.9);
        this.#pin("g", "space", () => group.visible ? group.localToWorld(end.clone()) : null);
    }

    /** Add the line from the planet through a satellite, with an arrow that points to the planet. */
    #addVertical() {
        if (!this.data.orbit) return;
        const {Vector3, Group} = libraries, group = new Group();
        const arrow = this.#arrow("space");
        arrow.position.set(1.9, 0, 0);
        Drawing.#aim(arrow, new Vector3(-3.8, 0, 0));
        group.add(arrow);
        this.vertical = new Group();
        this.vertical.add(group);
        this.world.add(this.vertical);
        this.parts.vertical = [group];
        const end = new Vector3(-2, 0, 0);
        this.#pin("planet", "space", () => group.visible ? this.vertical.localToWorld(end.clone()) : null);
    }

    /** Show Poinsot's ellipsoid and plane, and the cones, of a free body with this state. */
    construction(state) {
        for (const group of [...(this.parts.poinsot ?? []), ...(this.parts.cones ?? [])]) group.removeFromParent();
        const visible = {poinsot: this.wished?.poinsot ?? false, cones: this.wished?.cones ?? false};
        Object.assign(this.parts, {poinsot: [], cones: []});
        if (!state) return;      // the body is at rest
        const {omega, momentum, energy, inertia, axes, quaternion, symmetryAxis} = state;
        const {Mesh, SphereGeometry, MeshStandardMaterial, DoubleSide, RingGeometry, Vector3, Matrix4, ConeGeometry,
            Quaternion, Group} = libraries;
        const scale = LONGEST/this.arrows.omega.size, length = Math.hypot(...momentum);
        const translucent = (colour, opacity) => new MeshStandardMaterial({
            color: colour, transparent: true, opacity, side: DoubleSide, depthWrite: false,
        });
        const ellipsoid = new Group(), plane = new Group();
        const surface = new Mesh(new SphereGeometry(1, 64, 40), translucent(this.colours.polhode, 0.35));
        surface.scale.set(...inertia.map((moment) => scale*Math.sqrt(2*energy/moment)));
        const turned = new Group();
        turned.add(surface);
        turned.setRotationFromMatrix(new Matrix4().set(
            ...axes[0], 0, ...axes[1], 0, ...axes[2], 0, 0, 0, 0, 1));
        ellipsoid.add(turned);
        const normal = new Vector3(...momentum).divideScalar(length);
        const disk = new Mesh(new RingGeometry(0, 2.6, 96), translucent(this.colours.momentum, 0.22));
        disk.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), normal);
        disk.position.copy(normal).multiplyScalar(scale*2*energy/length);
        plane.add(disk);
        this.body.add(ellipsoid);
        this.world.add(plane);
        this.parts.poinsot = [ellipsoid, plane];
        this.parts.cones = [];
        if (symmetryAxis >= 0) {
            const omegaUnit = new Vector3(...omega).normalize();
            const turn = new Quaternion(quaternion[1], quaternion[2], quaternion[3], quaternion[0]);
            const axis = new Vector3(...axes.map((row) => row[symmetryAxis]));
            const spaceOmega = omegaUnit.clone().applyQuaternion(turn);
            const cone = (direction, about, colour, parent) => {
                const height = LONGEST*Math.abs(direction.dot(about)), side = Math.sign(direction.dot(about)) || 1;
                const radius = Math.sqrt(Math.max(LONGEST**2 - height**2, 0));
                if (!(radius > 1e-3 && height > 1e-3)) return;
                const mesh = new Mesh(new ConeGeometry(radius, height, 64, 1, true), translucent(colour, 0.35));
                const towards = about.clone().multiplyScalar(side);
                mesh.quaternion.setFromUnitVectors(new Vector3(0, -1, 0), towards);
                mesh.position.copy(towards).multiplyScalar(height/2);
                const group = new Group();
                group.add(mesh);
                parent.add(group);
                this.parts.cones.push(group);
            };
            cone(omegaUnit, axis, this.colours.polhode, this.body);
            cone(spaceOmega, normal, this.colours.momentum, this.world);
        }
        this.show("poinsot", visible.poinsot);
        this.show("cones", visible.cones);
    }

    /** Say how long the longest ω, L and M of the motion are, so that arrows keep one scale. */
    scales({omega, momentum, torque}) {
        this.arrows.omega.size = omega || 1;
        this.arrows.momentum.size = momentum || 1;
        this.arrows.torque.size = torque || 1;
    }

    show(name, visible) {
        this.isStale = true;
        this.wished = {...this.wished, [name]: visible};
        for (const group of this.parts[name] ?? []) group.visible = visible;
        if (name === "poinsot") this.solid.opacity = this.#opacity(visible && this.parts.poinsot?.length > 0);
    }

    isShown(name) {
        return this.parts[name]?.[0]?.visible ?? false;
    }

    /** Set the points of a path; `points` are coordinates x, y, z of one point after the other. */
    path(name, points, scale) {
        this.isStale = true;
        const line = this.paths[name], count = Math.min(points.length/3, MOST);
        const places = points.subarray(0, 3*count).map((value) => scale*value), {BufferGeometry, BufferAttribute, LineGeometry} = libraries;
        line.geometry.dispose();
        line.geometry = this.isSoftware ? new BufferGeometry().setAttribute("position", new BufferAttribute(places, 3))
            : new LineGeometry().setPositions(places);
        line.visible = true;
        return count;
    }

    /** Show the part of the trail up to a fraction of its points. */
    trailUpTo(fraction, count) {
        const segments = Math.max(1, Math.ceil(fraction*(count - 1))), {geometry} = this.paths.trail;
        if (this.isSoftware) geometry.setDrawRange(0, segments + 1);
        else geometry.instanceCount = segments;
    }

    pose({quaternion: [w, x, y, z], omega, momentum, torque, vertical}) {
        this.isStale = true;
        this.body.quaternion.set(x, y, z, w);
        for (const [name, value] of Object.entries({omega, momentum, torque})) {
            const {arrow, vector, size} = this.arrows[name], length = value ? Math.hypot(...value)/size*LONGEST : 0;
            arrow.visible = length > 0.02;
            if (!arrow.visible) continue;
            vector.set(...value).multiplyScalar(LONGEST/size);
            Drawing.#aim(arrow, vector);
        }
        this.vertical?.quaternion.set(0, 0, 0, 1).setFromAxisAngle(new libraries.Vector3(0, 0, 1), Math.atan2(vertical[1], vertical[0]));
        if (this.follow === "body") this.world.quaternion.copy(this.body.quaternion).invert();
        else if (this.follow === "vertical") this.world.quaternion.copy(this.vertical.quaternion).invert();
        else this.world.quaternion.identity();
    }

    /** Rotate the camera about the vertical and up or down, rad, and move it away by a factor. */
    turn(about, up, away) {
        const {position} = this.camera, {target} = this.controls, arm = position.clone().sub(target);
        const distance = Math.min(Math.max(arm.length()*away, this.controls.minDistance), this.controls.maxDistance);
        const azimuth = Math.atan2(arm.y, arm.x) + about;
        const height = Math.min(Math.max(Math.asin(arm.z/arm.length()) + up, -1.5), 1.5);
        position.set(Math.cos(height)*Math.cos(azimuth), Math.cos(height)*Math.sin(azimuth), Math.sin(height)).multiplyScalar(distance).add(target);
        this.isStale = true;
    }

    resize() {
        const {clientWidth: width, clientHeight: height} = this.canvas.parentElement;
        this.width = width;
        this.height = height;
        this.renderer.setPixelRatio(this.#pixels(true));
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width/Math.max(height, 1);
        this.camera.fov = this.camera.aspect < 1 ? 48 : 35;
        this.camera.updateProjectionMatrix();
        this.isStale = true;
    }

    /** Return how many pixels of the picture a pixel of the page has. */
    #pixels(isMoving) {
        return this.isSoftware ? isMoving ? 1 : 2 : Math.min(window.devicePixelRatio, 2);
    }

    /** Draw a frame if anything has changed since the last one; `isMoving` if the next frame will be another one. */
    render(isMoving = false) {
        const isDragged = this.controls.update(), pixels = this.#pixels(isMoving || isDragged);
        if (pixels !== this.renderer.getPixelRatio()) {
            this.renderer.setPixelRatio(pixels);
            this.isStale = true;
        }
        if (!isDragged && !this.isStale) return;
        this.isStale = false;
        this.renderer.render(this.scene, this.camera);
        const places = [];      // of the labels so far: a label that would cover another one moves aside
        for (const {element, place} of this.pins) {
            const point = place()?.project(this.camera);
            const hidden = !point || Math.abs(point.z) > 1;
            element.style.visibility = hidden ? "hidden" : "visible";
            if (hidden) continue;
            let x = (point.x + 1)/2*this.width;
            const y = (1 - point.y)/2*this.height;
            Object.assign(element.style, {left: "0", top: "0"});
            const width = APART*(1 + element.textContent.length)/2;
            while (places.some(([a, b, other]) => Math.abs(a - x) < (width + other)/2 && Math.abs(b - y) < APART)) x += APART/2;
            places.push([x, y, width]);
            element.style.transform = `translate(-50%, -50%) translate(${x}px, ${y}px)`;
        }
    }

    /** Put the labels where they stay in place when the picture changes its size, as on paper. */
    pinInPercent() {
        for (const {element} of this.pins) {
            const [x, y] = element.style.transform.match(/[-\d.]+(?=px)/g) ?? [0, 0];
            Object.assign(element.style, {left: `${100*x/this.width}%`, top: `${100*y/this.height}%`, transform: "translate(-50%, -50%)"});
        }
    }

    get ratio() {
        return this.width/this.height;
    }

    /** How many objects the last frame was drawn with. */
    get calls() {
        return this.renderer.info.render.calls;
    }

    static TIP = TIP;
    static TRAIL = TRAIL;
    static MOST = MOST;
    static LONGEST = LONGEST;
    static ARROWS = ARROWS;
}
