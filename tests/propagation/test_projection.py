"""The Taylor stepper keeps the invariants of its motion: they are found exactly, restored, and never made worse."""

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from symrot.bench import long
from symrot.build import cache as library
from symrot.codegen.lowering.tape import tape_of
from symrot.codegen.taylor.invariant_source import invariant_definitions, projectable
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import parse
from symrot.planning.plan import make_plan
from symrot.planning.scene_kernel import bind
from symrot.propagation.binding import Binding, two_doubles
from symrot.propagation.compiled_models import error_blocks, invariant_source, scene_kernel
from symrot.propagation.steppers import taylor
from symrot.propagation.steppers.stepping import Integration
from symrot.scene.scene import Scene
from tests.codegen.test_recurrences import program

TILTED = {"axis": [1, 0, 0], "angle": "1/2"}
GRAVITY = {"kind": "gravity", "weight": 1, "center_of_mass": ["1/10", "1/5", "9/10"]}


class Body:
    """A scene's stepper with its invariants."""

    def __init__(self, omega, moments=(1, 2, 3), torque=(), **more):
        body = {"principal": list(moments), **({"about": "fixed_point"} if torque else {})}
        form = {
            "schema": 1, "title": "body", "body": body, "initial": {"omega": list(omega), "attitude": TILTED},
            "span": {"t": [0, 1], "samples": 2}, "output": {"quantities": ["omega", "quaternion"]}, **more,
        }  # fmt: skip
        plan = make_plan(Scene.from_dict(form | ({"torque": list(torque)} if torque else {}), "body"))
        self.kernel = kernel = scene_kernel(plan)
        source = taylor.translation_unit(kernel.rates, *error_blocks(plan), 20, invariant_source(kernel, plan.states))
        self.path = library.build(source, "body")
        self.p = [
            *bind(kernel.rate_parameters, plan.constants),
            *Binding(kernel.quantity_parameters, plan, two_doubles)(plan),
        ]
        self.start, self.plan = [float(value) for value in plan.initial_state], plan

    def at(self, t, tolerance=1e-15, **more):
        return taylor.integration(self.path, self.p, self.start, 0.0, tolerance, **more).sample([t])[0][0]

    def drift(self, state):
        """Return the largest change of a kept invariant, computed exactly."""
        values = {name: Fraction(v) for (name, _), v in zip(self.kernel.quantity_parameters, bind(
            self.kernel.quantity_parameters, self.plan.constants), strict=True)}  # fmt: skip
        outputs = [item.output for item in self.kernel.conserved if item.holds]
        both = []
        for y in (state, self.start):
            known = values | {name: Fraction(float(v)) for name, v in zip(self.plan.states, y, strict=True)}
            both.append(self.kernel.quantities.evaluate(known, {}, Fraction, outputs))
        return max(float(abs(both[0][name] - both[1][name])) for name in outputs)


def quantities(formulas, states=("x", "y"), parameters=("k",)):
    def components(names):
        return tuple((name, "", "") for name in names)

    arguments = (
        Argument("t", "in", components(["t"]), True), Argument("y", "in", components(states)),
        Argument("p", "in", components(parameters)), Argument("out", "out", components(formulas)),
    )  # fmt: skip
    return Program(Signature("f", arguments), (), tuple((name, parse(text)) for name, text in formulas.items()))


def test_a_tape_holds_equal_operations_once():
    tape = tape_of(quantities({"a": "(x + y)**3 + x*y", "b": "x*y"}), ["a", "b"])
    assert sum(op.kind == "*" for op in tape.operations) == 3  # x*y, and two for the cube
    assert sum(op.kind == "+" for op in tape.operations) == 2
    assert tape_of(quantities({"a": "x**(-2)"}), ["a"]).operations[-1].kind == "/"


FORMULAS = {
    "a": "x*x*k + y/(3 + x) - 1/3", "b": "sqrt(x*x + y*y) - (-x)*t", "c": "(x - y)**5", "d": "x/7 - y*k", "e": "k",
}  # fmt: skip


def test_invariants_hold_32_digits_and_their_gradients_16():
    """Both agree with 50 digits; an invariant that contains a sine is left out."""
    given = quantities({**FORMULAS, "f": "sin(x)"})
    assert projectable(given, [*FORMULAS, "f"]) == list(FORMULAS)
    text = invariant_definitions(given, [*FORMULAS, "f"], ("x", "y"), ("k",))
    probe = """
    SYMROT_EXPORT void probe(const double *y, const double *p, double *value, double *gradient)
    {
        dd state[2], found[SYMROT_INVARIANTS];
        for (int i = 0; i < 2; ++i) state[i] = dd_pair(y[2*i], y[2*i + 1]);
        symrot_invariants(dd_pair(0.75, 0.0), state, p, found, (double (*)[SYMROT_STATES])gradient);
        for (int m = 0; m < SYMROT_INVARIANTS; ++m) { value[2*m] = found[m].hi; value[2*m + 1] = found[m].lo; }
    }
    """
    source = taylor.translation_unit(program({"x": "-k*y", "y": "k*x"}), (0, 2), (1.0,), 4, text)
    import ctypes

    loaded = ctypes.CDLL(str(library.build(source + probe, "probe")))
    x, y, k = 0.7, -1.3, 0.11
    real = ctypes.c_double
    value, gradient = (real * 10)(), (real * 10)()
    loaded.probe((real * 4)(x, 1e-18, y, -3e-19), (real * 2)(k, 2e-20), value, gradient)
    with mpmath.workdps(50):
        at = {"x": mpmath.mpf(x) + mpmath.mpf(1e-18), "y": mpmath.mpf(y) + mpmath.mpf(-3e-19),
              "k": mpmath.mpf(k) + mpmath.mpf(2e-20), "t": mpmath.mpf("0.75")}  # fmt: skip
        for m, name in enumerate(FORMULAS):

            def f(a, b, name=name):
                return given.evaluate({**at, "x": a, "y": b}, {"sqrt": mpmath.sqrt}, lambda v: mpmath.mpf(v.numerator)
                                      / v.denominator, [name])[name]  # fmt: skip

            exact = f(at["x"], at["y"])
            assert abs(mpmath.mpf(value[2 * m]) + value[2 * m + 1] - exact) < 1e-30
            for i, direction in enumerate(((1, 0), (0, 1))):
                slope = mpmath.diff(f, (at["x"], at["y"]), direction)
                assert abs(gradient[2 * m + i] - slope) < 4e-15 * max(1, abs(slope))


@pytest.mark.parametrize(
    "body",
    [
        {"omega": ["3/10", 1, "1/2"]},
        {"omega": ["1/2", "3/10", 4], "moments": [1, "3/2", "7/10"], "torque": [GRAVITY]},
        {"omega": ["1/2", "3/10", 1], "torque": [{"kind": "rotor", "angular_momentum": [0, "1/5", "1/3"]}]},
    ],
    ids=["free", "heavy top", "gyrostat"],
)
def test_what_is_kept_stays_within_round_off(body):
    """In 1000 s no invariant drifts beyond the last bits of the states; without projection they do."""
    body = Body(**body)
    size = np.abs(body.start).max()
    assert body.drift(body.at(1000.0)) < 6 * 2.0**-52 * size**2
    assert body.drift(body.at(1000.0, project=False)) > body.drift(body.at(1000.0))


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-15])
@pytest.mark.parametrize("omega", [["3/10", 1, "1/2"], ["1e-9", "1e-9", 1], ["1e-6", 1, "1e-6"]], ids=str)
def test_projection_never_makes_it_worse(monkeypatch, tolerance, omega):
    """S29, S12: projected often, at every tolerance, about unstable axes too: energy and momentum end no worse."""
    monkeypatch.setattr(taylor, "PROJECTED_EVERY", 4)
    body = Body(omega)
    on, off = body.at(300.0, tolerance), body.at(300.0, tolerance, project=False)
    assert np.isfinite(on).all()
    assert body.drift(on) <= max(body.drift(off), 4e-16)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-9, 1e-12])
def test_projected_motions_are_ten_times_as_good(tolerance):
    """After 180 revolutions: errors of the invariants make the motion run ahead ever faster, and only they do."""
    body = Body(["3/10", 1, "1/2"])
    best = body.at(1000.0, 1e-15)
    on, off = (np.abs(body.at(1000.0, tolerance, project=project) - best).max() for project in (True, False))
    assert on < max(off / 10, 2e-14)


def test_motions_of_which_nothing_is_right_are_refused_ever_more_seldom():
    body = Body(["3/10", 1, "1/2"])
    task = Integration(taylor._stepper, body.path, body.p, body.start, 0.0, 0.5)
    task.fields["every"], task.allowed, task.pace = 2, 30.0, 1e-300
    run = next(task.runs(300.0))
    task.advance(run, None, 0, None, None, 0)
    assert run.projected == 0 and run.every >= 64


def test_a_thousand_revolutions_against_the_exact_motion():
    """The energy keeps its last bits, and the attitude is far better than without projection; the command goes to 1e6."""
    found = long.measure(long.STATES[0], 3000)
    assert found["taylor, projected"][0] < 3e-16 and found["taylor, projected"][1] < 3e-13
    assert found["taylor, plain"][1] > 5 * found["taylor, projected"][1]


def test_the_norm_that_was_given_is_kept_when_it_is_not_one():
    """The stepper keeps the norm of the quaternion that the caller gave, even if it is not 1."""
    body = Body(["3/10", 1, "1/2"])
    body.start[3:] = [2 * q for q in body.start[3:]]
    assert math.isclose(np.linalg.norm(body.at(20.0)[3:]), 2.0, rel_tol=1e-15)
