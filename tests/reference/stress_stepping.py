"""Stress tests S17, S24 to S34, S39 and S42: the steppers agree with exact motions and 50-digit series."""

import math
from fractions import Fraction as F

import numpy as np

from symrot.bench import taylor as race
from symrot.build import cache as library
from symrot.errors import CompilerError
from symrot.planning.plan import make_plan
from symrot.planning.scene_kernel import bind
from symrot.propagation.binding import Binding, two_doubles
from symrot.propagation.compiled_models import error_blocks, invariant_source, scene_kernel
from symrot.propagation.propagate import propagator
from symrot.propagation.steppers import taylor
from tests.closed_form.test_heavy_top import S18, tilted
from tests.reference.figures import Figure, apart, body, largest, propagated

TILT = {"quaternion": [str(x) for x in tilted(F(1, 2))]}
GRAVITY = {"kind": "gravity", "weight": 1}
PLATE, PLATE_STATES = (1, 3, 4), (  # a flat body: its coefficients (B - C)/A and so on are exact in doubles
    ("3/8", 1, "1/2"), (1, "1/4", "1/8"), ("1/4", "3/8", 1), ("5/8", "3/4", "-1/2"), ("1/2", "1/2", "1/2"),
    ("-1/4", 1, "3/8"), ("7/8", "-1/8", "3/4"), ("1/8", "5/8", "1/4"),
)  # fmt: skip


def symmetric_top(omega=S18["loops"], attitude=TILT):
    return body((1, 1, "1/2"), [str(w) for w in omega], [{**GRAVITY, "center_of_mass": [0, 0, 1]}], attitude)


def asymmetric_top():
    arm = {**GRAVITY, "center_of_mass": ["1/10", "1/5", "9/10"]}
    return body((1, "3/2", "7/10"), ("1/2", "3/10", 4), [arm], TILT)


class Stepped:
    """A scene's Taylor stepper, bound to numbers; if asked, it projects the carry onto the invariants."""

    def __init__(self, scene, order=20, flags=library.FLAGS):
        self.plan = plan = make_plan(scene)
        self.kernel = kernel = scene_kernel(plan)
        source = taylor.translation_unit(
            kernel.rates, *error_blocks(plan), order, invariant_source(kernel, plan.states)
        )
        self.path = library.build(source, "taylor", flags)
        self.p = [
            *bind(kernel.rate_parameters, plan.constants),
            *Binding(kernel.quantity_parameters, plan, two_doubles)(plan),
        ]
        self.start = [float(value) for value in plan.initial_state]

    def task(self, tolerance=1e-15, every=0, **more):
        found = taylor.integration(self.path, self.p, self.start, 0.0, tolerance, **more)
        found.fields["every"] = every
        return found

    def at(self, t, tolerance=1e-15, every=0, **more):
        return self.task(tolerance, every, **more).sample(np.atleast_1d(np.asarray(t, dtype=float)))

    def with_tail(self, t, tail, every=0, **more):
        """Return what :meth:`at` returns, with the same size ``tail`` of last terms allowed in every step, as S25 and
        S29 demand.
        """
        task = self.task(1e-12, every, **more)
        task.allowed, task.pace = tail, 1e-300
        return task.sample(np.atleast_1d(np.asarray(t, dtype=float)))

    def changes(self, state):
        """Return the changes of the kept quantities, in exact arithmetic, relative to the largest quantity."""
        values = bind(self.kernel.quantity_parameters, self.plan.constants)
        known = {name: F(v) for (name, _), v in zip(self.kernel.quantity_parameters, values, strict=True)}
        outputs = [item.output for item in self.kernel.conserved if item.holds]
        both = [
            self.kernel.quantities.evaluate(
                known | {n: F(float(v)) for n, v in zip(self.plan.states, y, strict=True)}, {}, F, outputs
            )
            for y in (state, self.start)
        ]
        size = max(abs(value) for value in both[1].values())
        return np.array([float((both[0][name] - both[1][name]) / size) for name in outputs])

    def drift(self, state):
        """Return the largest change of a kept quantity, in exact arithmetic, relative to the largest quantity."""
        return float(np.abs(self.changes(state)).max())


def s17(long):
    found = []
    for speed in (1, 1000, 1000000):
        scene = body((1, "3/2", 2), ("1/1000", "1/1000", speed))
        pair = [propagated(scene, m, 1e-9, [1000.0 / speed]).quaternion for m in ("taylor", "exact")]
        found.append(Figure("taylor", f"attitude, W = {speed:.0e}", 1e-8, largest(*pair, sign=True)))
    return found


MAP = {1e-6: 8e-5, 1e-8: 1e-6, 1e-10: 3e-9, 1e-12: 2e-10, 1e-14: 1e-12, 1e-16: 2e-14, 1e-17: 7e-15}
"""Errors that a prototype of the Taylor stepper reached, by the last terms that its steps allowed."""


def s24(long):
    """Projected, as users get it; and unprojected, where the figure of one tail is chance: tails near it, two times
    wider either way.
    """
    problem, exact = race.SteppedProblem("heavy asymmetric", 1.0), race.reference("heavy asymmetric")
    path, plain = problem.taylor_library(), problem.taylor_library(project=False)

    def ratio(library_, p, tail, least):
        task = taylor.integration(library_, p, problem.y0, 0.0, 1e-12)
        task.allowed, task.pace = tail, 1e-300
        return problem.largest_error(task.sample([200.0])[0][0], exact) / least

    near = [0.5 * 2.0 ** (k / 8) for k in range(17)] if long else [0.5, 1.0, 2.0]
    held = [ratio(path, problem.taylor_p, tail * f, least) for tail, least in MAP.items() for f in near]
    loose = {tail: ratio(plain, problem.p, tail, least) for tail, least in MAP.items()}
    worst = max(loose, key=lambda tail: loose[tail])
    spread = [ratio(plain, problem.p, worst * f, MAP[worst]) for f in near]
    found = [
        Figure("taylor", f"error over the prototype's, {len(held)} tails, 5e-18 to 2e-6", 10, max(held)),
        Figure(
            "taylor, plain",
            f"the same, median of {len(near)} about {worst:.0e}, the worst",
            10,
            float(np.median(spread)),
        ),
        Figure("taylor, plain", f"the same, at {worst:.0e} alone", 10, loose[worst], judged=False),
    ]
    errors = {}
    for tolerance in [10.0**-k for k in range(4, 16)]:
        states, _ = taylor.integration(path, problem.taylor_p, problem.y0, 0.0, tolerance).sample([200.0])
        errors[tolerance] = problem.largest_error(states[0], exact)
    worst = max(error / tolerance for tolerance, error in errors.items() if tolerance >= 1e-13)
    return [*found, Figure("taylor", "error over tolerance, 1e-4 to 1e-13", 10, worst),
            Figure("taylor", "least error", 7e-14, min(errors.values()))]  # fmt: skip


def s26(long):
    free = body((1, 2, 3), ("3/10", 1, "1/2"))
    found = [Figure("taylor", "S1 to t = 1000", 2e-13, apart(
        *(propagated(free, m, 1e-15, np.linspace(100, 1000, 10)) for m in ("taylor", "exact"))))]  # fmt: skip
    for name in ("cusps", "loops", "waves"):
        pair = [propagated(symmetric_top(S18[name]), m, 1e-15, np.linspace(20, 200, 10)) for m in ("taylor", "exact")]
        found.append(Figure("taylor", f"S18 {name} to t = 200", 2e-13, apart(*pair)))
    return found


def _long_runs(states, revolutions, every):
    """Return relative errors of the energy, and attitude errors in rad, of plates: two arrays of shape (states,
    revolutions).
    """
    energies, attitudes = [], []
    for omega in states:
        scene = body(PLATE, omega, attitude={"quaternion": [1, 0, 0, 0]})
        stepped = Stepped(scene)
        times = np.array(revolutions) * 2 * math.pi / np.linalg.norm(stepped.start[:3])
        found, _ = stepped.at(times, every=every)
        exact = propagated(scene, "exact", 1e-15, times)
        moments = [F(m) for m in PLATE]
        before = sum(m * F(w) ** 2 for m, w in zip(moments, stepped.start[:3], strict=True))
        energies.append([abs(float(sum(m * F(float(w)) ** 2 for m, w in zip(moments, y[:3], strict=True)) / before - 1))
                         for y in found])  # fmt: skip
        q = found[:, 3:] / np.linalg.norm(found[:, 3:], axis=1, keepdims=True)
        half = np.minimum(*(np.linalg.norm(q - s * exact.quaternion, axis=1) for s in (1, -1))) / 2
        attitudes.append(4 * np.arcsin(half))
    return np.array(energies), np.array(attitudes)


def s27(long):
    count, top = (8, 5) if long else (4, 4)
    revolutions = 10.0 ** np.linspace(2, top, 4 * (top - 2) + 1)
    energies, attitudes = _long_runs(PLATE_STATES[:count], revolutions, 0)
    slopes = [float(np.polyfit(np.log(revolutions), np.median(np.log(each + 1e-18), axis=0), 1)[0])
              for each in (energies, attitudes)]  # fmt: skip
    span = f"to 1e{top} rev, {count} states"
    return [Figure("taylor, plain", f"slope of the energy, {span}", 0.7, slopes[0]),
            Figure("taylor, plain", f"slope of the attitude, {span}", 1.7, slopes[1]),
            Figure("taylor, plain", f"attitude at 1e{top} rev, rad", 1e-8, float(np.median(attitudes[:, -1])))]  # fmt: skip


def s28(long):
    stepped = Stepped(body((1, 2, 3), ("3/10", 1, "1/2")))
    task = stepped.task(1e-12)
    run = next(task.runs(1000.0))
    task.advance(run, None, 0, None, None, 0)
    refused = 0
    for flags in (("-ffast-math",), ("-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math")):
        try:
            Stepped(body((1, 2, 3), ("3/10", 1, "1/2")), flags=(*library.FLAGS, *flags)).at(1.0)
        except CompilerError:
            refused += 1
    return [Figure("taylor", f"largest carry after {run.accepted} steps", 2.0**-60, max(map(abs, run.carry)), at_least=True),
            Figure("taylor", "builds without a carry that are refused, of 2", 2, refused, at_least=True)]  # fmt: skip


def s29(long):
    """Drifts at the end, and their mean square over 200 samples, since a drift may pass zero at any one time."""
    scenes = {"free": body((1, 2, 3), ("3/10", 1, "1/2")), "symmetric top": symmetric_top(), "heavy": asymmetric_top()}
    times, broken, ratios = np.linspace(0.0, 200.0, 201)[1:], 0, {}
    for name, scene in scenes.items():
        stepped = Stepped(scene)
        for tail in [10.0**-k for k in range(2, 18)]:
            on, off = (stepped.with_tail(times, tail, every)[0] for every in (4, 0))
            broken += int((~np.isfinite(on)).sum())
            drifts = [np.array([stepped.drift(y) for y in states]) for states in (on, off)]
            ratios[name, tail] = [a / max(b, 4e-16) for a, b in zip(*(_end_and_span(d) for d in drifts), strict=True)]
    found = [Figure("taylor, projected", "not finite, tails 1e-2 to 1e-17", 0, broken)]
    for place, title in enumerate(("drift at the end over that without", "its mean square", "largest of it")):
        worst = max(ratios, key=lambda key: ratios[key][place])
        title = f"{title}: {worst[0]}, {worst[1]:.0e}"
        found.append(Figure("taylor, projected", title, 1, ratios[worst][place], judged=place < 2))
    return found


def _end_and_span(drifts):
    return drifts[-1], math.sqrt((drifts**2).mean()), drifts.max()


def s30(long):
    """Compare projection every 4 steps, for which the bars were set, with every 16 steps, the users' setting.

    The bars were set for medians.
    """
    top, count, found = *((5, 8) if long else (3, 1)), []
    for every in (4, taylor.PROJECTED_EVERY):
        energies, attitudes = _long_runs(PLATE_STATES[:count], [10.0**top], every)
        title = f"1e{top} rev, every {every} steps, worst of {count}"
        found += [Figure("taylor, projected", f"energy at {title}", 3e-16, float(energies.max())),
                  Figure("taylor, projected", f"attitude, rad, at {title}", 1e-10, float(attitudes.max()))]  # fmt: skip
    return found


def s31(long):
    revolutions = 1e4 if long else 1e3
    found = []
    for name, scene in (
        ("symmetric top: E, L_z, L_3", symmetric_top()),
        ("asymmetric top: E, L_z", asymmetric_top()),
        ("free: E, L in space", body((1, 2, 3), ("3/10", 1, "1/2"))),
    ):
        stepped, title = Stepped(scene), f"{name}, {revolutions:.0e} rev"
        speed = float(np.linalg.norm([float(w) for w in scene.initial.omega_b]))
        stop = revolutions * 2 * math.pi / speed
        states, stats = stepped.at(stop)
        found.append(Figure("taylor, plain", title, 1e-13, stepped.drift(states[0])))
        if not found[-1].good:  # whose fault: the last terms left out, 1e-18 of each step, or rounding
            shorter, more = stepped.at(stop, max_step=0.6 * stop / stats.accepted)
            why = f"why: in {more.accepted} steps, not {stats.accepted}"
            found.append(Figure("taylor, plain", why, 0, stepped.drift(shorter[0]), judged=False))
            projected = stepped.drift(stepped.at(stop, every=16)[0][0])
            found.append(Figure("taylor, projected", "as users get it", 0, projected, judged=False))
    return found


def s32(long):
    scene = symmetric_top()
    stop = (1e3 if long else 1e2) * 2 * math.pi / 4.4
    stepped, exact = Stepped(scene), propagated(scene, "exact", 1e-15, [stop])
    task = stepped.task()
    runs = task.runs(stop)
    run = next(runs)
    while task.advance(run, None, 0, None, None, 0):
        pass
    moving = sum(name.startswith("omega") for name in stepped.plan.states)
    forward = largest(np.array(run.y[moving:]), exact.quaternion[0], sign=True)
    run.stop, run.next, run.unit = 0.0, 0, 0.0  # back, the carry kept
    while task.advance(run, None, 0, None, None, 0):
        pass
    back = largest(run.y, stepped.start)
    return [Figure("taylor, plain", f"return error over forward error {forward:.0e}", 100, back / max(forward, 1e-16))]


def _rates_by_coefficients(gyro, omega, stop, bits=200, order=40):
    """Return omega at the time ``stop``, by integer series of Euler's equations with exactly these coefficients."""

    def fixed(x):
        return round(F(x) * 2**bits)

    g, w, now = [fixed(x) for x in gyro], [fixed(x) for x in omega], F(0)
    while now < stop:
        terms = [[x] for x in w]
        for n in range(order):
            for i in range(3):
                a, b = terms[(i + 1) % 3], terms[(i + 2) % 3]
                total = sum(x * y for x, y in zip(a[: n + 1], b[n::-1], strict=True)) >> bits
                terms[i].append((g[i] * total >> bits) // (n + 1))
        step = min(F(1, 8), stop - now)
        h, w = fixed(step), []
        for one in terms:
            total = 0
            for coefficient in reversed(one):
                total = (total * h >> bits) + coefficient
            w.append(total)
        now += step
    return [x / 2**bits for x in w]


def s33(long):
    stop, omega, found = F(120), [F(3, 10), F(1), F(1, 2)], []
    revolutions = float(stop) * float(np.linalg.norm([float(w) for w in omega])) / (2 * math.pi)
    for moments in ((1, 2, 3), PLATE):
        scene, (a, b, c) = body(moments, omega), moments
        exact = [F(b - c, a), F(c - a, b), F(a - b, c)]
        rounded = [F(float(x)) for x in exact]
        stepped = Stepped(scene).at(float(stop))[0][0, :3]
        closed = propagated(scene, "exact", 1e-15, [float(stop)]).omega[0]
        with_exact, with_rounded = (_rates_by_coefficients(g, omega, stop) for g in (exact, rounded))
        found += [
            Figure("exact", f"{moments}, {revolutions:.0f} rev, exact coefficients", 1e-15, largest(closed, with_exact)),
            Figure("taylor", f"{moments}, per rev, rounded coefficients", 1e-15,
                   largest(stepped, with_rounded) / revolutions),
            Figure("", f"{moments}, per rev, what rounding them changes", 0,
                   largest(with_exact, with_rounded) / revolutions, judged=False),
        ]  # fmt: skip
    return found


def s34(long):
    t, steps, errors = np.linspace(-3, 8, 45), [], {"quaternion": [], "ZXZ": []}
    sizes = ["1/10", "1/1000", "1/1000000", "1/10000000000", 0]
    for theta in sizes:
        attitude = {"sequence": "ZXZ", "angles": ["1/5", theta, "3/10"]}
        scene = body((1, "6/5", 2), (0, "2/5", 1), attitude=attitude)
        exact = propagated(scene, "exact", 1e-15, t)
        for state, kept in errors.items():
            trajectory = propagated(scene, "taylor", 1e-14, t, state=state)
            kept.append(apart(trajectory, exact))
            if state == "quaternion":
                steps.append(trajectory.stats.accepted)
    return [Figure("taylor", "quaternion as state, passes at 1e-1 .. 0", 1e-13, max(errors["quaternion"])),
            Figure("taylor", f"spread of its {min(steps)} steps", 1, max(steps) - min(steps)),
            Figure("taylor", "angles as state, with switching", 1e-13, max(errors["ZXZ"]))]  # fmt: skip


def s39(long):
    scene, random = symmetric_top(), np.random.default_rng(39)
    count = 200_000 if long else 20_000
    stepper = propagator(scene, "taylor", 1e-9)
    t = random.uniform(-50, 50, count)
    t[:50], t[50:100] = 0.0, t[100]
    exact = propagator(scene, "exact")
    errors = {}
    for name, times in (("random", t), ("sorted", np.sort(t)), ("ends", np.array([-50.0, 50.0]))):
        errors[name] = apart(stepper(times), exact(times))
    start = stepper([0.0])
    changed = int((start.y[:, 0] != stepper.plan.initial_state).sum())
    ratio = max(errors["random"], errors["sorted"]) / errors["ends"]
    fast = symmetric_top((0, 0, 500))
    times = np.linspace(10, 200, 20)
    stepped, same = Stepped(fast), propagated(fast, "exact", 1e-15, times)
    states, _ = stepped.at(times, max_step=200 / 122880)  # every sample time is a step's end, to rounding
    q = states[:, -4:] / np.linalg.norm(states[:, -4:], axis=1, keepdims=True)
    return [Figure("taylor", f"{count} samples, error over that of the ends", 2, ratio),
            Figure("taylor", "states at t = 0 that changed a bit", 0, changed),
            Figure("taylor", "samples at step ends, spin 500", 1e-12, largest(q, same.quaternion, sign=True))]  # fmt: skip


def s42(long):
    """A square wave, a wave with several jumps inside a step, and a blow: constant between jumps, so that q is known."""

    def wave(t, omega, quaternion):
        return (0.0, 0.0, 1.0 if t % 1.0 < 0.5 else -1.0)

    scene, t = body((1, 1, 1), (0, 0, 0), attitude={"quaternion": [1, 0, 0, 0]}), np.array([0.3, 1.2, 2.75, 4.0])
    jumps, found = np.arange(0.5, 4.5, 0.5), []
    phase = t % 1.0
    rate = np.where(phase < 0.5, phase, 1.0 - phase)
    angle = np.floor(t) / 4 + np.where(phase < 0.5, phase**2 / 2, 0.25 - (1 - phase) ** 2 / 2)
    tried = {}
    for tolerance in (1e-6, 1e-9, 1e-12):
        trajectory = propagator(scene, tolerance=tolerance, torque=wave, switching_times=jumps)(t)
        error = max(largest(trajectory.omega[:, 2], rate), largest(trajectory.quaternion[:, 3], np.sin(angle / 2)))
        tried[tolerance] = (error / tolerance, trajectory.stats)
    worst, rejected = max(each[0] for each in tried.values()), sum(each[1].rejected for each in tried.values())
    found.append(Figure("dop853", "square wave, error over tolerance", 1, worst))
    found.append(Figure("dop853", "rejected steps at declared switches", 0, rejected))
    steps = [each[1].accepted for each in tried.values()]  # an order lost would multiply them by 1e3^(1/2) and more
    found.append(Figure("dop853", f"steps {steps} for 1e-6, 1e-9, 1e-12: last ratio", 1e3**0.25, steps[-1] / steps[1]))
    width = 1e-3

    def blow(t, omega, quaternion):
        return (0.0, 0.0, 1.0 / width if 2.0 < t < 2.0 + width else 0.0)

    struck = propagator(scene, tolerance=1e-12, torque=blow, switching_times=[2.0, 2.0 + width])([1.0, 2.0, 4.0])
    error = largest(struck.omega[:, 2], [0, 0, ((2.0 + width) - 2.0) / width])
    found.append(Figure("dop853", "a blow of 1 ms: omega after it", 1e-12, error))
    return found
