"""Inverse trigonometric functions, exponentials, logarithms, dependent roots and constants, above all their branches.

The oracle is values to 60 digits by mpmath, computed here node by node; if a function has no real value, neither has
the formula. A claim is "true" only if no point contradicts it, and "false" only with a point at which the sides differ.
"""

from fractions import Fraction
from random import Random

import pytest
from mpmath import iv, mp
from sympy import (
    Abs,
    Integer,
    Rational,
    acos,
    asin,
    atan,
    atan2,
    cos,
    cosh,
    exp,
    expand,
    log,
    pi,
    sin,
    sinh,
    sqrt,
    symbols,
    sympify,
    tan,
    tanh,
)

import symrot
from symrot.errors import InputError
from symrot.exact import is_zero, normal_form
from symrot.exact.angles import cyclotomic
from symrot.exact.decide import decide
from symrot.exact.intervals import arc_tangent, is_nonnegative_at

x, y = symbols("x y", real=True)
p = symbols("p", positive=True)

TRUE = {
    "sin(asin(x)) == x": ("-1 <= x <= 1",),
    "cos(asin(x)) == sqrt(1 - x**2)": ("-1 <= x <= 1",),
    "sin(2*acos(x)) == 2*x*sqrt(1 - x**2)": ("-1 <= x <= 1",),
    "sin(2*atan(x)) == 2*x/(1 + x**2)": (),
    "tan(atan(x)/2) == x/(1 + sqrt(1 + x**2))": (),
    "sin(acos(x)/2)**2 == (1 - x)/2": ("-1 <= x <= 1",),
    "cos(a + atan(x)) == (cos(a) - x*sin(a))/sqrt(1 + x**2)": (),
    "cos(atan2(y, x))*sqrt(x**2 + y**2) == x": ("x**2 + y**2 != 0",),
    "Rz(atan2(y, x))*Matrix([sqrt(x**2 + y**2), 0, 0]) == Matrix([x, y, 0])": ("x**2 + y**2 != 0",),
    "asin(x) + acos(x) == pi/2": ("-1 <= x <= 1",),
    "y*asin(x) + y*acos(x) == pi*y/2": ("-1 <= x <= 1",),
    "2*atan(x) == atan2(2*x, 1 - x**2)": (),
    "acos(x) == 2*asin(sqrt((1 - x)/2))": ("-1 <= x <= 1",),
    "4*atan(1/5) - atan(1/239) == pi/4": (),
    "diff(asin(x), x) == 1/sqrt(1 - x**2)": ("-1 < x < 1",),
    "diff(acos(cos(x)/2), x) == sin(x)/sqrt(4 - cos(x)**2)": None,
    "diff(atan(f(t)), t) == diff(f(t), t)/(1 + f(t)**2)": (),
    "diff(atan2(y, x), y) == x/(x**2 + y**2)": ("x**2 + y**2 != 0",),
    "exp(a)*exp(b) == exp(a + b)": (),
    "exp(3*x/2)**2 == exp(x)**3": (),
    "cosh(x)**2 - sinh(x)**2 == 1": (),
    "sinh(x + y) == sinh(x)*cosh(y) + cosh(x)*sinh(y)": (),
    "tanh(2*x) == 2*tanh(x)/(1 + tanh(x)**2)": (),
    "diff(tanh(x), x) == 1 - tanh(x)**2": (),
    "diff(exp(-a*t)*cos(b*t), t) == -exp(-a*t)*(a*cos(b*t) + b*sin(b*t))": (),
    "exp(log(x)) == x": ("x > 0",),
    "log(x*y) == log(x) + log(y)": ("x > 0", "y > 0"),
    "log(exp(x)*y) == x + log(y)": None,
    "diff(log(sin(x)), x) == cot(x)": ("sin(x) > 0",),
    "sqrt(x**2 + 2*x*y + y**2) == abs(x + y)": (),  # the radicand is a square
    "sqrt(x - 1)*sqrt(x + 1) == sqrt(x**2 - 1)": ("x >= 1",),
    "sqrt(x/y) == sqrt(x*y)/abs(y)": ("x*y >= 0", "y != 0"),
    "sqrt(x)**2 == abs(x)": ("x >= 0",),
    "sqrt((1 + cos(x))/2) == abs(cos(x/2))": (),
    "sqrt(5 + 2*sqrt(6)) == sqrt(2) + sqrt(3)": (),
    "sin(pi/5) == sqrt(10 - 2*sqrt(5))/4": (),
    "cos(pi/7) - cos(2*pi/7) + cos(3*pi/7) == 1/2": (),
    "tan(3*pi/11) + 4*sin(2*pi/11) == sqrt(11)": (),
    "sin(x + pi/9)*sin(x - pi/9) == sin(x)**2 - sin(pi/9)**2": (),
    "4*sin(pi/180)*sin(59*pi/180)*sin(61*pi/180) == sin(pi/60)": (),
}


@pytest.mark.parametrize("claim", TRUE)
def test_true_claims_are_proven_with_their_domain(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "true"
    if TRUE[claim] is not None:
        assert verdict.conditions == TRUE[claim]


FALSE = (
    "sin(asin(x)) == x**2",
    "sin(2*atan(x)) == 2*x/(1 - x**2)",
    "sin(2*acos(x)) == 2*x*(1 - x**2)",
    "3*asin(x) == asin(4*x**3 - 3*x)",
    "atan2(-y, -x) == atan2(y, x)",
    "diff(acos(x), x) == 1/sqrt(1 - x**2)",
    "exp(a*b) == exp(a)*exp(b)",
    "diff(cosh(x), x) == -sinh(x)",
    "log(x + y) == log(x) + log(y)",
    "log(x)**2 == 2*log(x)",
    "sqrt(x)**2 == x**2",
    "sqrt(x**2 + y**2) == x + y",
    "cos(pi/7) == 9/10",
    "sin(pi/180) == pi/180",
    "4*atan(1/5) - atan(1/240) == pi/4",
)


@pytest.mark.parametrize("claim", FALSE)
def test_false_claims_come_with_a_point_of_their_domain(claim):
    verdict = symrot.check(claim, repair=False)
    assert verdict.verdict == "false"
    left, right = (value(sympify(side), {}) for side in (verdict.counterexample.lhs, verdict.counterexample.rhs))
    assert abs(left - right) > mp.mpf(10) ** -30
    point = {symbols(name, real=True): sympify(text) for name, text in verdict.counterexample.values.items()}
    sides = [sympify(side, {str(s): s for s in (x, y)}) for side in claim.split("==")]
    if "diff" not in claim and all(s.is_Symbol for s in point):
        plain = {str(s): v for s, v in point.items()}
        again = [value(side.xreplace({s: plain[str(s)] for s in side.free_symbols}), {}) for side in sides]
        assert [abs(a - b) < mp.mpf(10) ** -30 for a, b in zip(again, (left, right), strict=True)] == [True, True]


CONDITIONAL = {
    "atan(y/x) == atan2(y, x)": "x > 0",
    "atan(x) + atan(1/x) == pi/2": "x > 0",
    "sqrt(x/y) == sqrt(x*y)/y": "x >= 0 and y > 0",
    "sqrt(x**2 - 2*x + 1) == x - 1": "x >= 1",
    "sqrt(1 - sin(x)**2) == cos(x)": "cos(x) >= 0",
    "atan(x) + atan(y) == atan((x + y)/(1 - x*y))": "x*y < 1",
    "asin(sin(x)) == x": "-pi/2 <= x <= pi/2",
    "acos(cos(x)) == x": "0 <= x <= pi",
    "3*asin(x) == asin(3*x - 4*x**3)": "-1/2 <= x <= 1/2",
    "2*atan(tan(x/2)) == x": "-pi < x < pi",
}


@pytest.mark.parametrize("claim", CONDITIONAL)
def test_what_holds_on_one_branch_says_which(claim):
    verdict = symrot.check(claim, repair=False)
    assert (verdict.verdict, verdict.requires) == ("conditional", (CONDITIONAL[claim],))
    assert verdict.counterexample is not None


def test_an_assumption_chooses_the_branch():
    assert symrot.check("atan(y/x) == atan2(y, x)", assume=["x > 0"]).verdict == "true"
    assert symrot.check("atan(x) + atan(1/x) == pi/2", assume=["x > 0"]).verdict == "true"


def test_on_the_cut_of_atan2_nothing_is_claimed():
    """Half an atan2 is the atan2 of the half angle, except on the negative axis, which the conditions exclude."""
    verdict = symrot.check("atan2(y, x) == 2*atan2(y, x + sqrt(x**2 + y**2))")
    assert verdict.verdict == "true"
    assert any("sqrt(x**2 + y**2)" in condition and "!= 0" in condition for condition in verdict.conditions)


@pytest.mark.parametrize("power", [80, 100, 150])
def test_intervals_of_exponentials_and_logarithms_contain_the_value_beside_one(power):
    """``exp(t)`` is above ``1 + t``, and ``log(1 + t)`` below t, also by less than the precision of the interval."""
    small = Rational(1, 2**power)
    assert not is_nonnegative_at(1 + small - exp(small), {})
    assert not is_nonnegative_at(log(1 + small) - small, {})


def test_an_interval_that_touches_the_cut_of_atan2_from_below_refutes_nothing():
    """At x = 1 the square is 0, of which only an interval is known: atan2 has the value pi there, or is near -pi."""
    x = symbols("x", real=True)
    square = (sqrt(3) * sqrt(2 + x) - 3) ** 2
    assert decide(Abs(atan2(-square, -1)), pi - atan(square)).verdict != "false"


@pytest.mark.parametrize("claim", ["asin(2) == 1", "acos(-3/2) == 1", "log(-2) == 1", "log(0) == 1"])
def test_a_number_outside_the_domain_is_refused(claim):
    with pytest.raises(InputError, match=r"expected a (positive )?number"):
        symrot.check(claim)


def test_what_stays_undecided_names_its_term():
    verdict = symrot.check("3*sin(atan(x)/3) - 4*sin(atan(x)/3)**3 == x/sqrt(1 + x**2)")  # true
    assert verdict.verdict == "undecided" and "atan(x)" in verdict.reason


def test_proven_equal_functions_are_equal_inside_others():
    assert decide(sqrt(asin(x)), sqrt(pi / 2 - acos(x))).verdict == "true"
    assert decide(asin(x) ** 2 + atan(x), (pi / 2 - acos(x)) ** 2 + atan(x)).verdict == "true"


# -- constants --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("prime", [5, 7, 11, 13, 17])
def test_sums_of_gauss(prime):
    """The sum of the Legendre symbol times the p-th roots of unity is sqrt(p) or i sqrt(p) (Gauss, 1805)."""
    residues = {n * n % prime for n in range(1, prime)}
    trigonometric = cos if prime % 4 == 1 else sin
    signs = ((n, 1 if n in residues else -1) for n in range(1, prime))
    total = sum(sign * trigonometric(2 * pi * n / Integer(prime)) for n, sign in signs)
    assert is_zero(total - sqrt(prime))
    assert not is_zero(total - sqrt(prime) + Rational(1, 10**60))


@pytest.mark.parametrize("n", [4, 5, 7, 9, 12, 30, 90])
def test_minimal_polynomials_vanish_at_their_number(n):
    with mp.workdps(60):
        number = 2 * mp.cos(mp.pi / n)
        low_to_high = cyclotomic.minimal_polynomial(n)
        assert len(low_to_high) == cyclotomic.degree(n) + 1
        assert abs(mp.polyval(low_to_high[::-1], number)) < mp.mpf(10) ** -45
        for times in (3, n - 1, n + 2):
            found = mp.polyval(cyclotomic.doubled_cosine(times, n)[::-1], number)
            assert abs(found - 2 * mp.cos(times * mp.pi / n)) < mp.mpf(10) ** -40


def test_nearly_equal_numbers_are_told_apart():
    """Examples are a nested root and its first 40 digits, and two sums of roots that agree to 17 digits."""
    with mp.workdps(60):
        digits = int(mp.floor(mp.sqrt(2 + mp.sqrt(3)) * mp.mpf(10) ** 40))
    assert not is_zero(sqrt(2 + sqrt(3)) - Rational(digits, 10**40))
    assert is_zero(sqrt(2 + sqrt(3)) - (sqrt(6) + sqrt(2)) / 2)
    assert not is_zero(sqrt(1000001) + sqrt(1000025) + sqrt(1000031) - sqrt(1000084) - sqrt(999973) - 1000)


# -- random claims ----------------------------------------------------------------------------------------------------


class Undefined(ArithmeticError):
    """Raised if a formula has no real value."""


def value(formula, point):
    """Return a real value to 60 digits, or raise ``Undefined``; no code of the engine takes part."""
    with mp.workdps(60):
        return real_value(formula, point)


TINY = mp.mpf(10) ** -45


def real_value(node, point):
    if node.is_Rational:
        return mp.mpf(int(node.p)) / int(node.q)
    if node.is_Symbol:
        return point[node]
    if node.is_NumberSymbol:
        return +getattr(mp, "e" if str(node) == "E" else "pi")
    parts = [real_value(part, point) for part in node.args]
    name = type(node).__name__
    first = parts[0]
    if node.is_Add or node.is_Mul:
        return mp.fsum(parts) if node.is_Add else mp.fprod(parts)
    if node.is_Pow:
        negligible = abs(first) < TINY
        if (negligible and parts[1] < 0) or (first < 0 and not node.exp.is_Integer and not negligible):
            raise Undefined
        return first ** int(node.exp) if node.exp.is_Integer else abs(first) ** parts[1]
    if name in ("asin", "acos") and abs(first) > 1:
        if abs(first) > 1 + TINY:
            raise Undefined
        first = mp.sign(first)
    if name == "log" and first <= 0:
        raise Undefined
    if name == "atan2":
        if abs(first) < TINY and parts[1] < TINY:
            raise Undefined
        return mp.atan2(*parts)
    return abs(first) if name == "Abs" else getattr(mp, name)(first)


REWRITINGS = {  # function -> rewritings that hold, and rewritings that hold on one branch at most
    asin: ([lambda u: pi / 2 - acos(u), lambda u: atan2(u, sqrt(1 - u**2)), lambda u: 2 * atan(u / (1 + sqrt(1 - u**2)))],
           [lambda u: acos(sqrt(1 - u**2)), lambda u: asin(2 * u * sqrt(1 - u**2)) / 2]),
    acos: ([lambda u: pi / 2 - asin(u), lambda u: 2 * asin(sqrt((1 - u) / 2)), lambda u: atan2(sqrt(1 - u**2), u)],
           [lambda u: asin(sqrt(1 - u**2)), lambda u: acos(2 * u**2 - 1) / 2]),
    atan: ([lambda u: asin(u / sqrt(1 + u**2)), lambda u: 2 * atan(u / (1 + sqrt(1 + u**2)))],
           [lambda u: acos(1 / sqrt(1 + u**2)), lambda u: pi / 2 - atan(1 / u)]),
    sin: ([lambda u: 2 * sin(u / 2) * cos(u / 2)], [lambda u: sqrt(1 - cos(u) ** 2)]),
    cos: ([lambda u: 1 - 2 * sin(u / 2) ** 2], [lambda u: sqrt(1 - sin(u) ** 2), lambda u: sqrt((1 + cos(2 * u)) / 2)]),
    exp: ([lambda u: exp(u / 2) ** 2, lambda u: cosh(u) + sinh(u)], [lambda u: 1 + u]),
    log: ([lambda u: 2 * log(sqrt(u)), lambda u: -log(1 / u)], [lambda u: log(u**2)]),
    tanh: ([lambda u: 1 - 2 / (exp(2 * u) + 1)], [lambda u: sinh(u)]),
    Abs: ([lambda u: sqrt(expand(u**2))], [lambda u: u]),
}  # fmt: skip


def random_formula(source, depth):
    u = source.choice([x, y, p, x / 2, x + 1, x * y, x + y, Rational(1, 2)])
    if depth:
        u = source.choice([u, random_formula(source, depth - 1)])
    v = source.choice([x, x / 2, u / sqrt(1 + u**2), 2 * u / (1 + u**2), sin(x), cos(y)])
    turn = Rational(source.randint(1, 8), source.choice([5, 7, 12])) * pi
    makers = [
        lambda: asin(v), lambda: acos(v), lambda: atan(u), lambda: sin(2 * atan(u) + x), lambda: cos(acos(v) / 2),
        lambda: exp(x) * y, lambda: log(u), lambda: Abs(u), lambda: sqrt(u), lambda: sqrt(u**2 + 2 * u + 1),
        lambda: sin(x + turn), lambda: tan(x / 2) * tanh(y), lambda: sqrt(x * y) * u, lambda: atan2(y, x + 1),
    ]  # fmt: skip
    return source.choice(makers)() + source.choice([0, 1, x]) * source.choice([1, u])


def rewritten(node, source, wrong):
    if not node.args:
        return node
    node = node.func(*(rewritten(part, source, wrong) for part in node.args))
    kinds = REWRITINGS.get(type(node))
    return source.choice(kinds[wrong and source.random() < 0.7])(*node.args) if kinds else node


@pytest.mark.thinned(3)
@pytest.mark.parametrize("seed", range(6))
def test_no_random_claim_gets_a_wrong_verdict(seed):
    source = Random(seed)
    undecided = 0
    for number in range(12):
        left = random_formula(source, 1)
        right = rewritten(left, source, wrong=bool(number % 2))
        try:
            verdict = decide(left, right)
        except InputError:  # a refusal, not a verdict
            continue
        undecided += verdict.verdict == "undecided"
        if verdict.verdict == "true":
            assert not differs_somewhere(left, right, source), (left, right)
        if verdict.verdict == "false":
            point = dict(verdict.counterexample.point)
            sides = [value(side.xreplace(point), {}) for side in (left, right)]
            assert abs(sides[0] - sides[1]) > TINY, (left, right, point)
    assert undecided <= 3


def differs_somewhere(left, right, source):
    for _ in range(25):
        point = {x: Fraction(source.randint(-3000, 3000), 1009), y: Fraction(source.randint(-3000, 3000), 1013)}
        point[p] = Fraction(source.randint(1, 4000), 997)
        with mp.workdps(60):
            point = {name: mp.mpf(number.numerator) / number.denominator for name, number in point.items()}
        try:
            a, b = value(left, point), value(right, point)
        except (Undefined, ZeroDivisionError):
            continue
        if abs(a - b) > mp.mpf(10) ** -35 * (1 + abs(a) + abs(b)):
            return True
    return False


def test_normal_forms_of_new_functions_have_their_values():
    for formula in (sin(3 * atan(x)), cos(asin(x / 4) / 2 + y), tanh(x) ** 2 + exp(-y), sin(x + pi / 7) * cos(pi / 9)):
        point = {x: mp.mpf("0.7"), y: mp.mpf("-1.3")}
        assert abs(value(formula, point) - value(normal_form(formula), point)) < TINY


@pytest.mark.parametrize(
    "claim", ["asin(y) == 5*pi/2 - acos(y)", "acos(y) == 2*pi + acos(y)", "asin(y) == 2*pi - asin(-y)"]
)
def test_an_inverse_function_is_never_an_angle_beyond_its_range(claim):
    assert symrot.check(claim, repair=False).verdict == "false"


@pytest.mark.parametrize("claim", [
    "asin(pi/6) == pi/2 + acos(pi/6)", "acos(1/3) == asin(1/3) - pi/2", "asin(asin(1/2)) == pi/2 + acos(asin(1/2))",
])  # fmt: skip
def test_numbers_outside_of_a_range_make_a_claim_false_not_its_sides_undefined(claim):
    """asin(y) == pi/2 + acos(y) holds for y = 1 alone; that pi/6 - 1 is negative says nothing about the sides."""
    assert symrot.check(claim, repair=False).verdict == "false"
    assert symrot.check("asin(1) == pi/2 + acos(1)").verdict == "true"


@pytest.mark.parametrize("claim", [
    "acos(tanh(10)) == 0", "tan(acos(tanh(cosh(3)))) == 0", "exp(acos(tanh(10))) == 1", "x*sin(acos(tanh(10))) == 0",
    "log(tan(acos(tanh(cosh(3))))) > 0",
])  # fmt: skip
def test_an_arc_cosine_near_zero_is_not_zero(claim):
    """SymPy rounds tanh(10) to 1, and then takes its arc cosine for zero."""
    assert symrot.check(claim, repair=False).verdict == "false"


@pytest.mark.parametrize("bits", [64, 170])
def test_an_arc_tangent_is_within_its_interval(bits):
    """mpmath's own interval of 1.25 at 64 bits, among others, does not contain the arc tangent."""
    random, before = Random(5), iv.prec
    try:
        for _ in range(300):
            y, x = random.uniform(-9, 9), random.choice([1.0, random.uniform(-9, 9)])
            iv.prec = bits
            angle = arc_tangent(iv.mpf(y), iv.mpf(x))
            with mp.workprec(400):
                exact = mp.atan2(y, x)
                assert mp.mpf(angle.a) <= exact <= mp.mpf(angle.b), (y, x)
                assert angle.delta < 2.0 ** (5 - bits)
        assert arc_tangent(iv.mpf(0), iv.mpf(2)) == 0
    finally:
        iv.prec = before
