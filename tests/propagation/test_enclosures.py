"""Enclosures: a disc holds a function's image of another disc, and steps become short only where a feature may hide."""

import cmath
import ctypes
import math
import shutil
import subprocess
from fractions import Fraction

import numpy as np
import pytest

import symrot
from symrot.build import cache as library
from symrot.build.sources import c_text
from symrot.codegen.enclosure.source import enclosure_source
from symrot.codegen.enclosure.terms import BEYOND, enclosure
from symrot.codegen.taylor.coefficients import coefficients
from symrot.codegen.taylor.recurrences import recurrences
from symrot.errors import PropagationError
from symrot.formula.tree import evaluate, parse
from symrot.planning.plan import make_plan
from symrot.planning.scene_kernel import bind
from symrot.propagation.compiled_models import error_blocks, scene_kernel
from symrot.propagation.enclosures.step_limit import FUNCTIONS, Deviations, Disc, _product, longest_followed
from symrot.propagation.steppers import dop853, integration_stopped, stepping, taylor
from symrot.scene.scene import Scene
from tests.needs import needs_compiler

pytestmark = pytest.mark.usefixtures("quick_compiler")
RANDOM = np.random.default_rng(12)
COMPLEX = {name: getattr(cmath, name) for name in FUNCTIONS if name not in ("sech", "atan2")}
COMPLEX["sech"] = lambda z: 1 / cmath.cosh(z)
DOMAINS = {"log": (0.1, 5.0), "sqrt": (0.1, 5.0), "asin": (-0.9, 0.9), "acos": (-0.9, 0.9)}


def product(a, b):
    return Disc(*_product(a, b))


def image_of(name, disc, whole=1.0):
    """Return the image of a disc; a root has a corner, and ``whole`` says how far it is widened."""
    return FUNCTIONS[name](disc, whole) if name == "sqrt" else FUNCTIONS[name](disc)


def scene(torque, omega=(0, 0, 0), stop=10.0, tolerance=1e-10, **parameters):
    torque = torque if isinstance(torque, list) else ["0", "0", torque]
    content = {
        "schema": 1, "body": {"principal": [1, 2, 3]}, "initial": {"omega": list(omega)}, "span": {"t": [0, stop]},
        "torque": [{"kind": "expression", "torque": torque, "parameters": parameters}],
        "accuracy": {"tolerance": tolerance}, "output": {"quantities": ["omega", "quaternion"]},
    }  # fmt: skip
    return Scene.from_dict(content)


def circle(disc, count=64):
    angles = 2 * np.pi * np.arange(count) / count
    return [complex(disc.centre) + disc.radius * cmath.exp(1j * angle) for angle in angles]


@pytest.mark.parametrize("name", sorted(set(FUNCTIONS) - {"atan2"}))
def test_the_image_of_a_disc_lies_in_the_disc_of_its_image(name):
    """|f(z) - centre| <= radius on the circle, and hence inside, since analytic functions are largest at the boundary."""
    low, high = DOMAINS.get(name, (-30.0, 30.0) if name in ("tanh", "sech", "atan") else (-4.0, 4.0))
    bounded = 0
    for _ in range(400):
        disc = Disc(RANDOM.uniform(low, high), 10 ** RANDOM.uniform(-6, 1))
        image = image_of(name, disc)
        if not math.isfinite(image.radius):
            continue
        bounded += 1
        far = max(abs(COMPLEX[name](z) - image.centre) for z in circle(disc))
        assert far <= image.radius * (1 + 1e-9) + 1e-12 * abs(image.centre) + 1e-300, (disc, image)
    assert bounded > 100


FACTORS = ("exp", "sech", "cosh", "sinh", "sin", "cos", "tanh", "atan")


def factor(name, power, inner):
    own = image_of(name, product(inner, Disc(-inner.centre, inner.radius)) if name == "exp" else inner)
    return product(own, own) if power == 2 else own


def test_no_product_of_three_functions_leaves_its_disc():
    """Discs so large that bounds overflow or underflow: the product's disc is unbounded there, or holds the product."""
    import mpmath

    known = {name: getattr(mpmath, name) for name in FACTORS}
    bounded = 0
    for _ in range(1500):
        factors = [
            (str(RANDOM.choice(FACTORS)), int(RANDOM.choice([1, 1, 2])), float(10 ** RANDOM.uniform(0, 6)),
             float(RANDOM.uniform(-1, 1))) for _ in range(3)
        ]  # fmt: skip
        disc = Disc(float(RANDOM.uniform(-1, 1)), float(10 ** RANDOM.uniform(-7, 1)))
        image = Disc(1.0, 0.0)
        try:
            for name, power, slope, offset in factors:
                inner = Disc(slope * (disc.centre - offset), slope * disc.radius)
                image = product(factor(name, power, inner), image)
        except OverflowError:  # which :class:`Deviations` takes for an infinite bound
            continue
        assert not math.isnan(image.radius)
        if image.radius == math.inf:
            continue
        bounded += 1
        for z in circle(disc, 8):
            value = mpmath.mpf(1)
            for name, power, slope, offset in factors:
                inner = slope * (mpmath.mpc(z) - offset)
                value *= known[name](-inner * inner if name == "exp" else inner) ** power
            assert abs(value - image.centre) <= image.radius * (1 + 1e-6) + 1e-300, (factors, disc)
    assert bounded > 300


@pytest.mark.parametrize("centre", [-744.0, -745.2, -746.0, -800.0])
def test_a_pulse_that_underflows_is_not_taken_for_zero(centre):
    """exp(-746) is 0 as a double, but 1e300 times this number is not nothing."""
    import mpmath

    pulse, large = FUNCTIONS["exp"](Disc(centre, 0.25)), Disc(1e300, 0.0)
    strong = product(product(pulse, Disc(0.1, 0.0)), product(Disc(10.0, 0.0), large))
    for z in circle(Disc(centre, 0.25), 8):
        value = mpmath.exp(mpmath.mpc(z))
        assert abs(value - pulse.centre) <= pulse.radius
        assert abs(value * mpmath.mpf(1e300) - strong.centre) <= strong.radius * (1 + 1e-9)
    assert strong.radius < 1e-22  # logarithms and the underflow keep it small


def test_an_unbounded_factor_is_not_taken_for_zero():
    """The square of an unbounded bump in the angle, times a distant pulse whose bound overflows, is unbounded."""
    bump = FUNCTIONS["sech"](Disc(-19.7, math.inf))
    pulse = FUNCTIONS["exp"](Disc(-6e7, 1.2e10))
    assert product(product(bump, bump), pulse).radius == math.inf == product(pulse, product(bump, bump)).radius


@pytest.mark.thinned(2)
@needs_compiler
@pytest.mark.parametrize("method", ["taylor", "dop853", "scipy:RK45", "scipy:DOP853", "scipy:LSODA"])
def test_a_pulse_that_meets_a_bump_of_the_angle_is_seen(method):
    """Both are narrow, and their product acts only while the pulse comes as the body passes the bump."""
    rate, w = 40.0, 5e-7
    torque = "m*((1/cosh((2*atan2(q3, q0)-c)/v)**2)*exp(-((t-d)/w)**2))"
    made = scene(torque, (0, 0, rate), 0.1, 1e-7, m=1e6, c=43.0 * rate / 1000, d=0.043, v=0.008, w=w)
    gained = symrot.propagator(made, method)([0.1]).omega[-1, 2] - rate
    assert gained == pytest.approx(1e6 * w * math.sqrt(math.pi) / 3, rel=1e-4)  # the bump is wider than the way by far


def test_the_angle_of_two_discs_is_enclosed():
    for _ in range(400):
        y, x = (Disc(RANDOM.uniform(-2, 2), 10 ** RANDOM.uniform(-5, 0)) for _ in range(2))
        image = FUNCTIONS["atan2"](y, x)
        if not math.isfinite(image.radius):
            continue
        base = complex(x.centre, y.centre), complex(x.centre, -y.centre)
        for dy, dx in zip(circle(Disc(0, y.radius), 16), circle(Disc(0, x.radius), 16)[::-1], strict=True):
            upper, lower = 1 + (dx + 1j * dy) / base[0], 1 + (dx - 1j * dy) / base[1]
            assert abs((cmath.log(upper) - cmath.log(lower)) / 2j) <= image.radius * (1 + 1e-9)


@needs_compiler
def test_the_rules_in_c_are_those_in_python():
    names = sorted(set(FUNCTIONS) - {"atan2"})
    called = {"log": "ln"}
    further = {"sqrt": ", 7.0"}
    cases = "\n".join(
        f"case {k}: d = symrot_disc_{called.get(n, n)}(a{further.get(n, '')}); break;" for k, n in enumerate(names)
    )
    text = f"""#include <stdint.h>
#define SYMROT_ROUGH
{c_text("propagation/enclosures/disc.h")}
void image(int which, double c, double r, double *out)
{{ symrot_disc a = symrot_disc_of(c, r), d = a; switch (which) {{ {cases} }} out[0] = d.c; out[1] = d.r; }}
"""
    function, out = ctypes.CDLL(str(library.build(text, "discs"))).image, (ctypes.c_double * 2)()
    function.argtypes = (ctypes.c_int, ctypes.c_double, ctypes.c_double, ctypes.c_void_p)
    for k, name in enumerate(names):
        low, high = DOMAINS.get(name, (-20.0, 20.0))
        discs = [Disc(RANDOM.uniform(low, high), 10 ** RANDOM.uniform(-5, 0.5)) for _ in range(100)]
        for disc in [*discs, *([Disc(-746.0, 0.5), Disc(-900.0, 2.0)] if name == "exp" else [])]:
            function(k, disc.centre, disc.radius, out)
            expected = image_of(name, disc, 7.0)
            assert list(out) == pytest.approx(list(expected[:2]), rel=1e-12, nan_ok=True), (name, disc)


@needs_compiler
@pytest.mark.thinned(3)
@pytest.mark.parametrize("method", ["taylor", "dop853", "scipy:DOP853"])
def test_a_wave_within_a_vanished_pulse_costs_no_steps(method):
    """Far from its pulse, a chirp is exp(-1e6) times a wave with an overflowing bound: logarithms keep the product."""
    made = scene("exp(-((t-5)/w)**2)*sin(a*(t-5)**2)", (0, 0, 0.1), 10.0, w=1e-3, a=1e7)
    stats = symrot.propagator(made, method)([10.0]).stats
    assert stats.accepted < 5000  # without: millions


def rates(made):
    plan = make_plan(made)
    return plan, scene_kernel(plan)


@pytest.mark.parametrize(
    "torque", ["cos(3*t)/2", "t**2 - omega_3", "q1*q2 - omega_1*cos(t)", "-omega_3**3", "sin(t)**2*cos(2*t)**3"]
)
def test_polynomials_and_waves_need_no_enclosure(torque):
    assert enclosure(recurrences(rates(scene(torque))[1].rates)) is None


@pytest.mark.parametrize(
    "torque", ["exp(-t)", "cos(t)**8", "tanh(omega_3)", "1/(2 + q0)", "sin(t**2)", "sqrt(1 + t**2)", "cosh(t)"]
)
def test_what_may_hide_a_feature_is_enclosed(torque):
    plan, kernel = rates(scene(torque))
    found = enclosure(recurrences(kernel.rates))
    assert [bool(own) for own in found.terms] == [name == "omega_3" for name in plan.states]
    assert BEYOND > 6


@pytest.mark.parametrize(
    "torque",
    ["exp(-(t-1)**2)", "tanh(3*omega_3 + t)", "q1/(3 + omega_3*cos(t)**9)", "atan2(1 + q1, 2 + t)", "log(2 + t)"],
)
def test_coefficients_obey_the_bound(torque):
    """For polynomial states, coefficient n of an enclosed rate is at most its deviation over rho^n (Cauchy)."""
    made = scene(torque, (0.1, -0.2, 0.3))
    plan, kernel = rates(made)
    system = recurrences(kernel.rates)
    parameters = dict(
        zip([name for name, _ in kernel.rate_parameters], bind(kernel.rate_parameters, plan.constants), strict=True)
    )
    deviations = Deviations(enclosure(system), parameters)
    import mpmath

    with mpmath.workdps(40):
        functions = {
            name: getattr(mpmath, name) for name in ("sqrt", "exp", "log", "tanh", "atan2", "cos", "sin", "sech")
        }
        values = {**{k: mpmath.mpf(v) for k, v in parameters.items()}, "t": mpmath.mpf(0)}
        values |= {name: mpmath.mpf(y) for name, y in zip(plan.states, plan.initial_state, strict=True)}
        number = lambda value: mpmath.mpf(value.numerator) / value.denominator  # noqa: E731
        series = coefficients(system, 40, values, functions, number)
    for rho in (0.1, 0.3):
        radii = [float(sum(abs(c) * rho**n for n, c in enumerate(one) if n)) for one in series]
        bounds = deviations(0.0, rho, 1.0, plan.initial_state, radii)
        omega_3 = series[plan.states.index("omega_3")]
        bound = bounds[plan.states.index("omega_3")]
        assert 0 < bound < math.inf
        smooth = 1.0  # what is not enclosed: products of components of omega, of coefficients at most those
        for n in range(12, 39):
            rate = abs(omega_3[n + 1]) * (n + 1)
            assert rate <= (bound + smooth * rho) / rho**n


TERMS = [
    "exp(-m*(t-1)**2)*sin(3*t+m)**9", "tanh(3*omega_3 + t)/cosh(m*t)", "q1/(3 + omega_3*cos(m*t)**9)",
    "atan2(1 + q1, 2 + t) + exp(m*cos(2*t))", "log(2 + t*m)*sqrt(4 + omega_1)", "exp(900*m*t)*exp(-700*t)/(1 + q2**8)",
]  # fmt: skip


@pytest.mark.parametrize("torque", TERMS)
def test_a_torque_changes_within_the_discs_by_no_more_than_its_bound(torque):
    """|M(z) - M(y)|/C <= bound, at random complex times and states z in the discs around y."""
    import mpmath

    plan, kernel = rates(scene(torque, (0.1, -0.2, 0.3), m=1.5))
    names = [name for name, _ in kernel.rate_parameters]
    numbers = bind(kernel.rate_parameters, plan.constants)
    deviations = Deviations(enclosure(recurrences(kernel.rates)), dict(zip(names, numbers, strict=True)))
    functions = {name: getattr(mpmath, name) for name in ("sqrt", "exp", "log", "tanh", "cos", "sin", "cosh")}
    functions["atan2"] = lambda y, x: (mpmath.log(x + 1j * y) - mpmath.log(x - 1j * y)) / 2j

    def rate(t, y):
        values = {"m": mpmath.mpf(1.5), "t": mpmath.mpmathify(t), **dict(zip(plan.states, y, strict=True))}
        return evaluate(parse(torque), values, functions, lambda x: mpmath.mpf(x.numerator) / x.denominator) / 3

    finite, largest = 0, 0.0
    for _ in range(60):
        reach = 10 ** RANDOM.uniform(-4, 0.5)
        y = (np.array(plan.initial_state) + RANDOM.uniform(-0.3, 0.3, len(plan.states))).tolist()
        t, radii = RANDOM.uniform(-1, 2), (reach * RANDOM.uniform(0, 1, len(y))).tolist()
        bound = deviations(t, reach, 1.0, y, radii)[plan.states.index("omega_3")]
        finite += math.isfinite(bound)
        for _ in range(6 * math.isfinite(bound)):
            shift_t, *shift = np.exp(2j * np.pi * RANDOM.uniform(0, 1, 1 + len(y))) * [reach, *radii]
            change = abs(rate(t + shift_t, np.add(y, shift)) - rate(t, y))
            assert change <= bound * (1 + 1e-9) + 1e-15  # a factor exp(..) may underflow
            largest = max(largest, float(change / bound)) if bound else largest
    assert finite > 10 and largest > 0.1


def test_the_reach_that_is_tried_first_changes_no_step():
    plan, kernel = rates(scene("exp(-((t-5)/w)**2)", w=0.3))
    names = [name for name, _ in kernel.rate_parameters]
    numbers = dict(zip(names, bind(kernel.rate_parameters, plan.constants), strict=True))
    deviations, edges = Deviations(enclosure(recurrences(kernel.rates)), numbers), error_blocks(plan)[0]
    rest = (plan.initial_state, [[0.0] * 20 for _ in plan.states], 1.0, [1e-9] * (len(edges) - 1), edges, 20)
    lengths = set()
    for likely in range(8):
        deviations.likely = likely
        lengths.add(longest_followed(deviations, 3.5, *rest))
    assert len(lengths) == 1 and 0.0 < lengths.pop() < 1.0


def test_a_bound_that_is_too_small_would_let_a_pulse_pass():
    """The search for a step uses the enclosure: if that claims zero deviation, the whole step is taken."""
    made = scene("exp(-((t-5)/w)**2)", w=1e-3)
    plan, kernel = rates(made)
    terms = enclosure(recurrences(kernel.rates))
    parameters = dict(
        zip([n for n, _ in kernel.rate_parameters], bind(kernel.rate_parameters, plan.constants), strict=True)
    )
    edges = error_blocks(plan)[0]
    start = (0.0, plan.initial_state, [[0.0] * 20 for _ in plan.states], 10.0, [1e-12] * (len(edges) - 1), edges, 20)
    assert longest_followed(Deviations(terms, parameters), *start) < 5.0
    assert longest_followed(lambda t, reach, whole, y, radii: [0.0] * len(plan.states), *start) == 10.0


@needs_compiler
@pytest.mark.parametrize("stepper", [taylor, dop853], ids=["taylor", "dop853"])
def test_without_the_enclosure_the_pulse_is_missed(stepper):
    """So the tests of narrow torques do depend on the enclosure."""
    plan, kernel = rates(scene("exp(-((t-5)/w)**2)", w=1e-3))
    p, edges = bind(kernel.rate_parameters, plan.constants), error_blocks(plan)
    for enclosed in (True, False):
        if stepper is taylor:
            text, flags = taylor.translation_unit(kernel.rates, *edges, enclosed=enclosed), taylor.FLAGS
        else:
            bounds = enclosure_source(kernel.rates, dop853.DENSE_ORDER, edges[0]) if enclosed else dop853.NO_ENCLOSURE
            text = dop853.translation_unit(kernel.source, "symrot_rates", len(plan.states), len(p), *edges, bounds)
            flags = library.FLAGS
        states, _ = stepper.integration(library.build(text, "held", flags), p, plan.initial_state, 0.0, 1e-10).sample(
            [10.0]
        )
        omega = states[0, plan.states.index("omega_3")]
        assert (abs(omega - 1e-3 * math.sqrt(math.pi) / 3) < 1e-12) == enclosed


@needs_compiler
@pytest.mark.skipif(shutil.which("gcc") is None or shutil.which("g++") is None, reason="no GNU compilers")
@pytest.mark.parametrize(
    "command", [["gcc", "-std=c99", "-x", "c"], ["g++", "-std=c++11", "-x", "c++"]], ids=["c", "c++"]
)
def test_held_steppers_are_clean_c99_and_valid_cpp(command):
    plan, kernel = rates(scene(["tanh(t)*q1", "1/cosh(t)", "exp(-omega_3**2)"]))
    edges = error_blocks(plan)
    bounds = enclosure_source(kernel.rates, dop853.DENSE_ORDER, edges[0])
    p = len(kernel.rate_parameters)
    head = "#include <math.h>\n"
    units = [head + dop853.translation_unit(kernel.source, "symrot_rates", len(plan.states), p, *edges, bounds)]
    if command[0] == "gcc":
        units.append(taylor.translation_unit(kernel.rates, *edges))
    for unit in units:
        options = ["-Wall", "-Wextra", "-Wshadow", "-Werror", "-fsyntax-only", "-"]
        done = subprocess.run([*command, *options], input=unit, text=True, capture_output=True, check=False)
        assert done.returncode == 0, done.stderr


@pytest.mark.thinned(2)
@needs_compiler
@pytest.mark.parametrize("torque", ["exp(-t)/5", "exp(-(t-5)**2)", "tanh(t-5)/5", "sqrt(1+t**2)/50", "sin(t**2/4)/5"])
def test_smooth_torques_of_time_cost_no_more_steps(torque):
    """The enclosure costs at most a fifth more steps, over a span of about ten steps of the torque."""
    plan, kernel = rates(scene([torque, "0", torque], (0.3, 1, 0.5), 20.0, 1e-12))
    p, edges = bind(kernel.rate_parameters, plan.constants), error_blocks(plan)
    steps = []
    for enclosed in (False, True):
        path = library.build(taylor.translation_unit(kernel.rates, *edges, enclosed=enclosed), "held", taylor.FLAGS)
        steps.append(taylor.integration(path, p, plan.initial_state, 0.0, 1e-12).sample([20.0])[1].accepted)
    assert steps[1] <= 1.2 * steps[0] + 1


def test_a_function_without_series_is_not_enclosed():
    """abs has no Taylor series, so no enclosure: steppers locate its switches instead."""
    from symrot.formula.program import Argument, Program, Signature

    one = (("y", "", ""),)
    signature = Signature("f", (Argument("y", "in", one), Argument("dy", "out", (("dy", "", ""),))))
    assert "SYMROT_ENCLOSED 0" in enclosure_source(Program(signature, (), (("dy", parse("abs(y)")),)), 7, [0, 1])


@needs_compiler
@pytest.mark.parametrize("method", [pytest.param("taylor", marks=pytest.mark.campaign), "dop853"])
def test_a_hopeless_motion_is_given_up_with_its_samples(method, monkeypatch):
    monkeypatch.setattr(stepping, "PATIENCE", 2000)
    monkeypatch.setattr(integration_stopped, "HOPELESS", 1e-3)
    times = np.linspace(0, 20, 81)
    with pytest.raises(
        PropagationError, match=r"beyond t = \d.* more than the largest allowed number of 100000000"
    ) as caught:
        symrot.propagator(scene("exp(t**3)", (0, 0, 1)), method)(times)
    part = caught.value.trajectory
    assert len(part) > 4 and not part.success and part.status == -1
    assert (part.t == times[: len(part)]).all() and np.isfinite(part.omega).all()
    before = symrot.propagator(scene("exp(t**3)", (0, 0, 1)), method)(times[: len(part)])
    assert abs(part.omega - before.omega).max() < 1e-7 * abs(before.omega).max()


@needs_compiler
@pytest.mark.parametrize("method", ["taylor", "dop853", "scipy:DOP853"])
def test_an_interrupt_carries_the_samples_before(method, monkeypatch):
    from symrot.propagation import progress

    def stop(t, start, end):
        if t > 5.0:
            raise KeyboardInterrupt

    monkeypatch.setattr(taylor._Stepper, "steps_per_call", 5)
    made = symrot.propagator(scene("-tanh(omega_3)/9", (0.3, 1, 0.5), 100.0), method)
    monkeypatch.setattr(dop853._Stepper, "steps_per_call", 5)
    times = np.linspace(0, 100, 201)
    with progress.reporting(stop), pytest.raises(KeyboardInterrupt) as caught:
        made(times)
    part = caught.value.trajectory
    assert (5 if method != "scipy:DOP853" else 0) < len(part) < 200 and (part.t == times[: len(part)]).all()
    assert abs(part.omega - made(times).omega[: len(part)]).max() < 1e-8  # none of SciPy's coarse pass


def test_exact_numbers_of_weights_are_used():
    """Weights of a sum are exact fractions: exp(-t)/3 deviates by exactly a third of what exp(-t) does."""
    plan, kernel = rates(scene("exp(-t)/3"))
    parameters = dict(
        zip([n for n, _ in kernel.rate_parameters], bind(kernel.rate_parameters, plan.constants), strict=True)
    )
    bound = max(
        Deviations(enclosure(recurrences(kernel.rates)), parameters)(0.0, 0.5, 1.0, plan.initial_state, [0.0] * 9)
    )
    assert bound == pytest.approx(math.expm1(0.5) * float(Fraction(1, 9)), rel=1e-12)
