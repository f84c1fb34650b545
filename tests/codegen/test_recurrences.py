"""Recurrences give the Taylor coefficients: exact compared with differentiation, and to order 20 compared with mpmath."""

import math
import random
from fractions import Fraction

import mpmath
import pytest
import sympy
from sympy import Rational, Symbol

from symrot.codegen.taylor.coefficients import coefficients
from symrot.codegen.taylor.linear_forms import split_sign
from symrot.codegen.taylor.recurrences import recurrences
from symrot.errors import InputError
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import FUNCTIONS, evaluate, parse

SYSTEMS = {  # states and their rates; k is a parameter
    "free body": {"w1": "-k*w2*w3", "w2": "w3*w1/3", "w3": "2*w1*w2"},
    "quaternion": {
        "w": "0*w",
        "q0": "-(q1*w + q2*t)/2",
        "q1": "(q0*w + q3*t)/2",
        "q2": "q0*t - k*q1",
        "q3": "q1*q1 - q0**2",
    },
    "quotients": {"x": "y/(1 + x*x)", "y": "k/x - x/y + 1/(x*y)", "z": "(x - y)/(2*z - 2*x)"},
    "powers": {"x": "x**5 - k*y**3", "y": "y**(-3)*x**2", "z": "(x + y - 2*z)**3/k**2"},
    "time": {"x": "t*x - t**3/(1 + t)", "y": "(t - k)*(2*t + 3*k)*y"},
    "nested": {"x": "((x*y + 1)*y + x)*(x - y)", "y": "k*(x*y)*(x*y) - 3*(1 - 2*(x*y))"},
    "constant": {"x": "k", "y": "3/7", "z": "0*x"},
    "zero numerator": {"x": "x - (2 - 2)/(y*y)", "y": "x"},
}
FUNCTION_SYSTEMS = {  # right-hand sides in x, y, t and k, at points where all functions are smooth
    name: [f"{name}(k*x*y/3)", "x - t*y"] if count == 1 else [f"{name}(x - 1, y)", f"{name}(y, 2) - {name}(k, x)*t"]
    for name, count in FUNCTIONS.items()
    if name != "abs"
} | {
    "clocks": ["sin(2*t + k)*x - cos(k*t)*y + sinh(t)", "exp(-t/2)*cosh(3*t)*x + exp(k*t - 1)"],
    "functions of functions": ["exp(sin(x)*y)", "log(1 + exp(x)**2)/sqrt(1 + y*y)"],
    "shared": ["sin(x)**2 - tan(x)*cos(x)", "sqrt(x)*sqrt(x) + sqrt(x)/y"],
    "square root of a sum": ["-sqrt(x*x + y*y)*x", "-sqrt(x*x + y*y)*y - k*y"],
}  # fmt: skip
START = {"x": Fraction(3, 5), "y": Fraction(5, 4), "z": Fraction(-2, 3), "w1": Fraction(3, 10), "w2": Fraction(1), "w3": Fraction(1, 2),
         "w": Fraction(2, 3), "q0": Fraction(1, 2), "q1": Fraction(-1, 3), "q2": Fraction(3, 4), "q3": Fraction(1, 5),
         "t": Fraction(1, 7), "k": Fraction(4, 3)}  # fmt: skip


def program(rates, temporaries=()):
    def components(names):
        return tuple((name, "", "") for name in names)

    arguments = (
        Argument("t", "in", components(["t"]), True), Argument("y", "in", components(rates)),
        Argument("p", "in", components(["k"])), Argument("dy", "out", components([f"d{name}" for name in rates])),
    )  # fmt: skip
    return Program(
        Signature("rate", arguments),
        tuple((name, parse(formula)) for name, formula in temporaries),
        tuple((f"d{name}", parse(formula)) for name, formula in rates.items()),
    )


def derivatives(rates, order, start, value, functions=None):
    """Return the Taylor coefficients of the states by differentiating the rates along the motion.

    The derivatives x', x'', ... are symbols; each follows from the lower ones by ``x^(n+1) = d^n/dt^n f``.
    """
    jets = {name: [Symbol(f"{name}_{n}", real=True) for n in range(order + 1)] for name in rates}
    t, k = Symbol("t", real=True), Symbol("k", real=True)
    number = lambda v: Rational(v.numerator, v.denominator)  # noqa: E731
    now = {**{name: jet[0] for name, jet in jets.items()}, "t": t, "k": k}
    forms = {name: evaluate(parse(formula), now, functions, number) for name, formula in rates.items()}
    point = {t: start["t"], k: start["k"], **{jet[0]: start[name] for name, jet in jets.items()}}
    for n in range(1, order + 1):
        point |= {jets[name][n]: value(form, point) for name, form in forms.items()}
        forms = {
            name: form.diff(t) + sum(form.diff(jet[i]) * jet[i + 1] for jet in jets.values() for i in range(n))
            for name, form in forms.items()
        }
    return [[point[jet[n]] / math.factorial(n) for n in range(order + 1)] for jet in jets.values()]


RATIONAL = {name: Rational(value.numerator, value.denominator) for name, value in START.items()}


def exact(form, point):
    return form.xreplace(point)


def exact_coefficients(rates, order):
    series = coefficients(recurrences(program(rates)), order, START)
    return [[Rational(v.numerator, v.denominator) for v in map(Fraction, one)] for one in series]


@pytest.mark.thinned(2)
@pytest.mark.parametrize("order", [4, pytest.param(5, marks=pytest.mark.campaign)])
@pytest.mark.parametrize("name", SYSTEMS)
def test_coefficients_are_derivatives_exactly(name, order):
    """All orders up to one are computed with rational numbers, without rounding."""
    assert exact_coefficients(SYSTEMS[name], order) == derivatives(SYSTEMS[name], order, RATIONAL, exact)


SYMPY = {n: getattr(sympy, n) for n in FUNCTIONS if n != "abs"}


def in_digits(form, point):
    return sympy.lambdify(list(point), form, "mpmath", cse=True)(*point.values())


@pytest.mark.thinned(4)
@pytest.mark.parametrize("order", [3, *(pytest.param(order, marks=pytest.mark.campaign) for order in (4, 5))])
@pytest.mark.parametrize("name", FUNCTION_SYSTEMS)
def test_functions_are_differentiated(name, order):
    """The reference is SymPy's derivatives in 60 digits; each further order takes five times as long."""
    rates = dict(zip("xy", FUNCTION_SYSTEMS[name], strict=True))
    with mpmath.workdps(60):
        point = {n: as_mpf(value) for n, value in START.items()}
        series = coefficients(recurrences(program(rates)), order, point, MPMATH, as_mpf)
        for found, expected in zip(series, derivatives(rates, order, point, in_digits, SYMPY), strict=True):
            for n in range(order + 1):
                assert abs(found[n] - expected[n]) < mpmath.mpf(10) ** -50 * (1 + abs(expected[n]))


MPMATH = {n: getattr(mpmath, n) for n in FUNCTIONS if n != "abs"}


def as_mpf(value):
    return mpmath.mpf(value.numerator) / value.denominator


@pytest.mark.thinned(3)
@pytest.mark.parametrize("name", [*SYSTEMS, *FUNCTION_SYSTEMS])
def test_series_solve_the_equations_to_order_20(name):
    """mpmath's Taylor coefficients of the rates along the series equal those of the derivative of the series."""
    rates = SYSTEMS.get(name) or dict(zip("xy", FUNCTION_SYSTEMS[name], strict=True))
    with mpmath.workdps(60):
        start = {n: as_mpf(value) for n, value in START.items()}
        series = dict(zip(rates, coefficients(recurrences(program(rates)), 20, start, MPMATH, as_mpf), strict=True))
        for state, formula in rates.items():
            node = parse(formula)

            def rate(s, node=node):
                along = {n: mpmath.polyval(one[::-1], s) for n, one in series.items()}
                return evaluate(node, {**start, **along, "t": start["t"] + s}, MPMATH, as_mpf)

            expected = mpmath.taylor(rate, 0, 19)
            for n in range(20):
                found = (n + 1) * series[state][n + 1]
                assert abs(found - expected[n]) < mpmath.mpf(10) ** -25 * (1 + abs(expected[n])), (state, n)


def test_a_wrong_rule_is_noticed():
    """The same comparison fails if one coefficient is wrong by 1 part in 10^20, or one weight has the wrong sign."""
    rates = SYSTEMS["free body"]
    right, expected = exact_coefficients(rates, 5), derivatives(rates, 5, RATIONAL, exact)
    right[0][4] *= 1 + Rational(1, 10**20)
    assert right != expected
    assert exact_coefficients({**rates, "w1": "k*w2*w3"}, 5) != expected


def test_temporaries_are_shared_and_expanded_alike():
    plain = recurrences(program({"x": "(x*y + k)*x", "y": "(x*y + k)*y"}))
    named = recurrences(program({"x": "s*x", "y": "s*y"}, [("s", "x*y + k")]))
    assert plain == named


@pytest.mark.parametrize(
    "rates, products",
    [
        ({"x": "y*z", "y": "-2*z*y", "z": "y*z/3"}, 1),  # one product, three weights
        ({"x": "k*(2*x + 3*y)", "y": "x/k - y/7 + t", "z": "-(x - (y - 2*z))"}, 0),  # linear stays linear
        ({"x": "sin(2*t)", "y": "exp(k*t + 1)", "z": "cos(2*t)"}, 0),  # functions of the time alone
        ({"x": "(x - y)*z", "y": "(y - x)*z", "z": "2*(x - y)*z"}, 1),  # opposite and proportional factors
        ({"x": "x**4", "y": "x**2*y", "z": "x*x"}, 3),  # x^2, x^4, x^2 y
    ],
)
def test_convolutions_are_not_done_twice(rates, products):
    system = recurrences(program(rates))
    assert sum(s.rule not in ("state", "time", "sum", "clock", "theta") for s in system.series) == products


def test_sine_and_cosine_of_one_argument_are_one_pair():
    system = recurrences(program({"x": "sin(x*y)", "y": "cos(x*y) + sin(x*y)"}))
    assert [s.rule for s in system.series].count("driven") == 2


@pytest.mark.parametrize("formula", ["abs(x)", "x*abs(x)", "sqrt(abs(x + t))"])
def test_what_has_no_series_is_refused_in_one_sentence(formula):
    with pytest.raises(InputError, match=r"^method taylor: .*got abs of a quantity that changes"):
        recurrences(program({"x": formula}))


def test_abs_of_a_constant_is_a_constant():
    system = recurrences(program({"x": "abs(k)*x"}))
    (x,) = coefficients(system, 3, {"x": 2.0, "k": -3.0, "t": 0.0}, {"abs": abs}, float)
    assert x == [2.0, 6.0, 9.0, 9.0]


def test_signs_come_off_constants():
    assert split_sign(parse("-(-k)")) == (1, ("symbol", "k"))
    assert split_sign(("number", Fraction(-2))) == (-1, ("number", Fraction(2)))


def test_random_polynomial_systems_agree_with_differentiation():
    """The rates are sums of random monomials in three states (with a fixed seed); all orders up to one are exact."""
    source = random.Random(20)
    for order in (3, 3, 3, 4):
        rates = {
            name: " + ".join(
                f"{source.randint(-5, 5)}/{source.randint(1, 5)}*x**{source.randint(0, 3)}*y**{source.randint(0, 2)}*z**{source.randint(0, 2)}"
                for _ in range(source.randint(1, 4))
            )
            for name in "xyz"
        }
        assert exact_coefficients(rates, order) == derivatives(rates, order, RATIONAL, exact)
