"""Formulas in the notation of other languages are refused with what to write instead, and that can be parsed."""

import re

import pytest

import symrot
from symrot.errors import InputError
from symrot.formula import advice
from symrot.formula.switches import condition_error
from symrot.formula.tree import FUNCTIONS, SWITCHING, parse
from symrot.scene.scene import Scene
from tests.needs import needs_compiler

pytestmark = pytest.mark.usefixtures("quick_compiler")


def read(formula, **parameters):
    torque = {"kind": "expression", "torque": ["0", "0", formula], "parameters": parameters}
    more = {"body": {"principal": [1, 2, 3]}, "initial": {"omega": [0, 0, 1]}, "span": {"t": [0, 1], "samples": 2}}
    return Scene.from_dict({"schema": 1, "title": "x", "torque": [torque], **more}, "x")


@pytest.mark.parametrize(
    ("formula", "instead"),
    [
        ("stepp(t)", "did you mean 'step'?"), ("sgn(t)", "write sign(u)"), ("heaviside(t)", "write step(u)"),
        ("Heaviside(t)", "write step(u)"), ("fabs(t)", "write abs(u)"), ("Min(t, 1)", "did you mean 'min'?"),
        ("Max(t, 1)", "did you mean 'max'?"), ("maximum(t, 1)", "write max(a, b)"),
        ("minimum(t, 1)", "write min(a, b)"), ("saturate(t)", "write clip(u, low, high)"),
        ("fmod(t, 1)", "write mod(a, b), which has the sign of b"), ("t % 1", "write mod(a, b) for a % b"),
        ("1 if t < 1 else 2", "write where(condition, a, b)"), ("t^2", "write ** for a power"),
        ("where(t < 1 && t > 0, 1, 2)", "write 'and' between"), ("where(t < 1 || t > 3, 1, 2)", "write 'or' between"),
        ("where(!(t < 1), 1, 2)", "write 'not' before a condition"), ("where(t == 1, 1, 2)", "only at single instants"),
        ("where(t < 1, 2)", "write where(condition, a, b)"), ("clip(t, 1)", "write clip(u, low, high)"),
        ("where(1 < t < 2, 1, 0)", "one comparison at a time"), ("omega1", "write omega_1"), ("omega_x", "write omega_1"),
        ("wz", "write omega_3"), ("qw", "write q0"), ("omega[2]", "for one component"), ("ln(t)", "write log(u)"),
        ("arctan2(t, 1)", "write atan2(y, x)"), ("np.sin(t)", "without np."), ("2t", "write * between factors"),
        ("t(2)", "write * between t"), ("sin t", "write sin(..), with brackets"), ("t**(1/2)", "write sqrt(x)"),
        ("time", "write t"), ("T*2", "write t"), ("π*t", "write pi"), ("t²", "write **2"), ("e*t", "write exp(1)"),
    ],
)  # fmt: skip
def test_other_words_are_refused_with_the_word_to_write(formula, instead):
    with pytest.raises(InputError) as caught:
        read(formula)
    assert instead in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("write", sorted({*advice.FUNCTIONS.values(), *advice.SIGNATURES.values()}))
def test_what_is_advised_can_be_read(write):
    formula = write.partition(", with")[0].partition(", which")[0].partition(", a pulse")[0].partition(", for")[0]
    formula = formula.replace("condition", "u < 1").replace("u**n", "u**3")
    assert not condition_error(parse(formula, switching=True))


def test_no_word_that_formulas_know_is_among_the_foreign_ones():
    assert not set(advice.FUNCTIONS) & {*FUNCTIONS, *SWITCHING}
    assert set(SWITCHING) == set(advice.JUMPING)


def test_a_formula_that_knows_no_jumps_is_not_advised_to_use_them():
    """Events are zeros of smooth formulas."""
    with pytest.raises(InputError, match="allowed only in formulas of torques"):
        symrot.propagate("t_handle", events=["sign(omega_3)"])
    with pytest.raises(InputError) as caught:
        symrot.propagate("t_handle", events=["heaviside(t)"])
    assert "write step" not in str(caught.value)
    with pytest.raises(InputError, match=re.escape("got omega3 (write omega_3)")):
        symrot.propagate("t_handle", events=["omega3"])


@pytest.mark.parametrize(
    ("formula", "parameters"),
    [
        ("clip(t, 2, 1)", {}), ("clip(omega_3, a, -a)", {"a": 1}), ("1 + 2*clip(t, 2*a, b + 1)", {"a": 2, "b": "1/2"}),
        ("clip(t, sqrt(2), 1)", {}), ("clip(t, pi, 3)", {}), ("where(t < 1, clip(t, 1, 0), 0)", {}),
        ("clip(clip(t, 1, 0), 0, 1)", {}),
    ],
)  # fmt: skip
def test_a_clip_whose_limits_are_the_wrong_way_round_is_refused(formula, parameters):
    with pytest.raises(InputError, match=r"torque\[2\]: expected clip\(u, low, high\) with low <= high, got .*low is"):
        read(formula, **parameters)


@pytest.mark.parametrize("formula", ["clip(t, 1, 1)", "clip(t, omega_1, a)", "clip(t, -a, a)", "clip(t, log(-a), a)"])
def test_other_limits_of_a_clip_are_not(formula):
    read(formula, a=1)


@needs_compiler
def test_a_clip_of_formulas_that_cross_takes_the_lower_limit():
    """As docs/scene_format.md says, clip is max(low, min(u, high))."""
    scene = read("clip(t/10, 1 - t, t - 1)")
    omega = symrot.propagate(scene).omega[-1, 2]  # before t = 1 the limits have crossed: the torque is 1 - t
    assert omega == pytest.approx(1 + (1 / 2) / 3, rel=1e-11)
