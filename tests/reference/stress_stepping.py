"""Stress tests S17, S24 to S34 and S39 and S42: the steppers against exact motions and 50-digit series."""

import math
from fractions import Fraction as F

import numpy as np
from mpmath import mp

from symrot.bench import taylor as race
from symrot.codegen import library
from symrot.codegen.recurrences import coefficients, recurrences
from symrot.errors import CompilerError
from symrot.planner import make_plan
from symrot.propagation import taylor
from symrot.propagation.invariants import invariant_parameters, invariant_source
from symrot.propagation.kernels import error_blocks, scene_kernel
from symrot.propagation.propagator import propagator
from symrot.scene_kernel import bind
from tests.reference.figures import Figure, apart, body, largest, propagated
from tests.test_closed_form_heavy_top import S18, tilted

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
    """A scene's Taylor stepper, bound to numbers; the carry is projected onto the invariants if asked."""

    def __init__(self, scene, order=20, flags=library.FLAGS):
        self.plan = plan = make_plan(scene)
        self.kernel = kernel = scene_kernel(plan)
        source = taylor.translation_unit(
            kernel.rates, *error_blocks(plan), order, invariant_source(kernel, plan.states)
        )
        self.path = library.build(source, "taylor", flags)
        self.p = [*bind(kernel.rate_parameters, plan.constants), *invariant_parameters(kernel, plan)]
        self.start = [float(value) for value in plan.initial_state]

    def task(self, tolerance=1e-15, every=0, **more):
        found = taylor.task(self.path, self.p, self.start, 0.0, tolerance, **more)
        found.fields["every"] = every
        return found

    def at(self, t, tolerance=1e-15, every=0, **more):
        return self.task(tolerance, every, **more).sample(np.atleast_1d(np.asarray(t, dtype=float)))

    def with_tail(self, t, tail, every=0, **more):
        """Return what :meth:`at` returns, every step allowed the same last terms, as NUMERICS.md has it."""
        task = self.task(1e-12, every, **more)
        task.allowed, task.pace = tail, 1e-300
        return task.sample(np.atleast_1d(np.asarray(t, dtype=float)))

    def changes(self, state):
        """Return the changes of the kept quantities, in exact arithmetic, relative to the largest of them."""
        values = bind(self.kernel.quantity_parameters, self.plan.constants)
        known = {name: F(v) for (name, _), v in zip(self.kernel.quantity_parameters, values, strict=True)}
        outputs = [item.output for item in self.kernel.conserved if item.kept]
        both = [
            self.kernel.quantities.evaluate(
                known | {n: F(float(v)) for n, v in zip(self.plan.states, y, strict=True)}, {}, F, outputs
            )
            for y in (state, self.start)
        ]
        size = max(abs(value) for value in both[1].values())
        return np.array([float((both[0][name] - both[1][name]) / size) for name in outputs])

    def drift(self, state):
        """Return the largest change of a kept quantity, in exact arithmetic, relative to the largest of them."""
        return float(np.abs(self.changes(state)).max())


def s17(long):
    found = []
    for speed in (1, 1000, 1000000):
        scene = body((1, "3/2", 2), ("1/1000", "1/1000", speed))
        pair = [propagated(scene, m, 1e-9, [1000.0 / speed]).quaternion for m in ("taylor", "exact")]
        found.append(Figure("taylor", f"attitude, W = {speed:.0e}", 1e-8, largest(*pair, sign=True)))
    return found


MAP = {1e-6: 8e-5, 1e-8: 1e-6, 1e-10: 3e-9, 1e-12: 2e-10, 1e-14: 1e-12, 1e-16: 2e-14, 1e-17: 7e-15}
"""The errors of a prototype for the tails of its steps, NUMERICS.md, section 2."""


def s24(long):
    problem, exact = race._Problem("heavy asymmetric", 1.0), race.reference("heavy asymmetric")
    path, ratios, errors = problem.taylor_library(project=False), {}, {}
    for tail, least in MAP.items():
        task = taylor.task(path, problem.p, problem.y0, 0.0, 1e-12)
        task.allowed, task.pace = tail, 1e-300
        ratios[tail] = problem.error(task.sample([200.0])[0][0], exact) / least
    found = [Figure("taylor, plain", "error over the prototype's, tails 1e-6 to 1e-17", 10, max(ratios.values()))]
    if not found[0].good:
        worst = max(ratios, key=ratios.get)
        rest = max(ratio for tail, ratio in ratios.items() if tail != worst)
        found.append(Figure("taylor, plain", f"why: at the tails other than {worst:.0e}", 10, rest, judged=False))
        tails = sorted(MAP)
        below, above = (MAP[tails[tails.index(worst) + k]] for k in (-1, 1))
        between = math.sqrt(below * above)
        why = f"why: there, over the mean {between:.1e} of the prototype's neighbours"
        found.append(Figure("taylor, plain", why, 10, ratios[worst] * MAP[worst] / between, judged=False))
        found.append(Figure("prototype", why, 10, MAP[worst] / between, judged=False))
    path = problem.taylor_library()
    for tolerance in [10.0**-k for k in range(4, 16)]:
        states, _ = taylor.integrate(path, problem.taylor_p, problem.y0, 0.0, [200.0], tolerance)
        errors[tolerance] = problem.error(states[0], exact)
    worst = max(error / tolerance for tolerance, error in errors.items() if tolerance >= 1e-13)
    return [*found, Figure("taylor", "error over tolerance, 1e-4 to 1e-13", 10, worst),
            Figure("taylor", "least error", 7e-14, min(errors.values()))]  # fmt: skip


def _exact_steps(stepped, order, step, count):
    """Return the state after fixed steps of that order in 50 digits: what truncation alone makes of the motion."""
    system, state = recurrences(stepped.kernel.rates), [mp.mpf(x) for x in stepped.start]
    values = {name: mp.mpf(x) for name, x in zip(system.parameters, stepped.p, strict=False)} | {"t": mp.mpf(0)}
    for _ in range(count):
        values |= dict(zip(system.states, state, strict=True))
        rows = coefficients(system, order, values, {}, lambda x: mp.mpf(x.numerator) / x.denominator)
        state = [mp.polyval(row[::-1], mp.mpf(step.numerator) / step.denominator) for row in rows]
    return state


def s25(long):
    """The slope in doubles above 1e-13; orders 12 and 20 meet rounding before it: there 50 digits show the slope.

    The slope of 50 digits is that of fixed steps in 50 digits, once halved; the compiled steps have just that truncation error.
    """
    scene, found = asymmetric_top(), []
    with mp.workdps(50):
        for order in (8, 12, 16, 20):
            stepped = Stepped(scene, order)
            rounded, off = {}, Stepped(scene, 30).at([1.0], max_step=1 / 64)[0][0]
            for count in (1, 2, 4, 8, 16, 32):
                state = stepped.with_tail(1.0, 0.9, max_step=1 / count)[0][0]
                rounded[count] = largest(state[:3], off[:3])
            last = max(count for count, error in rounded.items() if error > 1e-13)
            seen = math.log2(rounded[last // 2] / rounded[last])
            found.append(
                Figure("taylor, doubles", f"p = {order}: slope {seen:.2f} above 1e-13, off by", 0.3, abs(seen - order))
            )
            close = _exact_steps(Stepped(scene), 30, F(1, 32), 32)
            if not found[-1].good:  # are the steps too long for the slope, or is it rounding
                ends = [_exact_steps(stepped, order, F(1, n), n) for n in (last // 2, last)]
                same = [max(abs(x - y) for x, y in zip(end[:3], close[:3], strict=True)) for end in ends]
                slope = float(mp.log(same[0] / same[1], 2))
                why = f"why: truncation alone, same {last // 2}, {last} steps: {slope:.2f}, off that by"
                found.append(Figure("50 digits", why, 0, abs(slope - seen), judged=False))
            fine = _exact_steps(Stepped(scene), 30, F(1, 128), 32)
            ends = [_exact_steps(stepped, order, F(1, n), n // 4) for n in (32, 64)]
            halved = [max(abs(x - y) for x, y in zip(end[:3], fine[:3], strict=True)) for end in ends]
            slope = float(mp.log(halved[0] / halved[1], 2))
            found.append(Figure("50 digits", f"p = {order}: slope {slope:.2f}, off by", 0.3, abs(slope - order)))
            count = 4 if order < 16 else 2
            expected = _exact_steps(stepped, order, F(1, count), count)
            states, stats = stepped.at(1.0, 0.9, max_step=1 / count)
            errors = [max(abs(x - y) for x, y in zip(end[:3], close[:3], strict=True))
                      for end in ([mp.mpf(float(x)) for x in states[0]], expected)]  # fmt: skip
            found.append(Figure("taylor", f"p = {order}: error {float(errors[0]):.0e} of {stats.accepted} steps over that",
                                0.01, float(abs(errors[0] / errors[1] - 1))))  # fmt: skip
    return found


def s26(long):
    free = body((1, 2, 3), ("3/10", 1, "1/2"))
    found = [Figure("taylor", "S1 to t = 1000", 2e-13, apart(
        *(propagated(free, m, 1e-15, np.linspace(100, 1000, 10)) for m in ("taylor", "exact"))))]  # fmt: skip
    for name in ("cusps", "loops", "waves"):
        pair = [propagated(symmetric_top(S18[name]), m, 1e-15, np.linspace(20, 200, 10)) for m in ("taylor", "exact")]
        found.append(Figure("taylor", f"S18 {name} to t = 200", 2e-13, apart(*pair)))
    return found


def _long_runs(states, revolutions, every):
    """Return relative errors of the energy and attitude errors in rad of plates, shapes (states, revolutions)."""
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
    scenes = {"free": body((1, 2, 3), ("3/10", 1, "1/2")), "symmetric top": symmetric_top(), "heavy": asymmetric_top()}
    broken, worst = 0, (0.0, "", 0.0)
    for name, scene in scenes.items():
        stepped = Stepped(scene)
        for tail in [10.0**-k for k in range(2, 18)]:
            on, off = (stepped.with_tail(200.0, tail, every)[0][0] for every in (4, 0))
            broken += int((~np.isfinite(on)).sum())
            worst = max(worst, (stepped.drift(on) / max(stepped.drift(off), 4e-16), name, tail))
    title = f"drift over that without, {worst[0]:.4f}: {worst[1]}, {worst[2]:.0e}"
    found = [Figure("taylor, projected", "not finite, tails 1e-2 to 1e-17", 0, broken),
             Figure("taylor, projected", title, 1, worst[0])]  # fmt: skip
    return found if found[1].good else found + _since_projected(Stepped(scenes[worst[1]]), worst[2])


def _since_projected(stepped, tail):
    """Show when a motion was last projected, what that took away, and the drift of it and of its twin since then.

    Errors left out of the sum early may be of the other sign than those that follow: the ends tell of chance.
    """
    times = np.linspace(0.0, 200.0, 401)
    on, off = (np.array([stepped.changes(y) for y in stepped.with_tail(times, tail, every)[0]]) for every in (4, 0))
    taken = on - off
    jumps = np.abs(np.diff(taken, axis=0)).max(axis=1)
    last = int(np.flatnonzero(jumps > jumps.max() / 10)[-1]) + 1
    gained = [float(np.abs(change[-1] - change[last]).max()) for change in (on, off)]
    return [
        Figure("taylor, projected", f"why: it was last projected before t = {times[last]:.1f}, by", 0, jumps.max(), judged=False),
        Figure("taylor, projected", f"why: drift since, over {gained[1]:.3e} without, less 1", 0, gained[0] / gained[1] - 1,
               judged=False),
    ]  # fmt: skip


def s30(long):
    """Projected every 4 steps, as NUMERICS.md has it; its own figures were medians of four states."""
    top, count = (5, 4) if long else (3, 2)
    energies, attitudes = _long_runs(PLATE_STATES[:count], [10.0**top], 4)
    found = [
        Figure("taylor, projected", f"relative energy at 1e{top} rev, worst of {count}", 3e-16, float(energies.max())),
        Figure("taylor, projected", f"attitude at 1e{top} rev, rad, worst of {count}", 1e-10, float(attitudes.max())),
        Figure("taylor, projected", "median energy of them", 3e-16, float(np.median(energies)), judged=False),
        Figure("taylor, projected", "median attitude of them", 1e-10, float(np.median(attitudes)), judged=False),
    ]
    if not found[1].good:
        oftener = _long_runs(PLATE_STATES[:count], [10.0**top], 2)[1].max()
        found.append(Figure("taylor, projected", "why: projected every 2 steps", 0, float(oftener), judged=False))
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
    """Return omega at a time, by series in whole numbers, of Euler's equations with these very coefficients."""

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
    """A square wave, a wave with several jumps inside a step, and a blow: constant between, so that q is known."""

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
