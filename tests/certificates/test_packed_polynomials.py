"""Packed polynomials have the terms of SymPy's polynomials, in the same order."""

from fractions import Fraction
from random import Random

import pytest
from sympy import QQ, ring

from symrot.certificates.truncation.packed_polynomials import PackedPolynomial, variables

NAMES = ["x", "omega_1", "t"]


def terms_of(polynomial):
    """Return the terms of a polynomial of SymPy as pairs (coefficient, powers)."""
    return [
        (Fraction(int(value.numerator), int(value.denominator)),
         tuple((name, power) for name, power in zip(NAMES, powers, strict=True) if power))
        for powers, value in polynomial.terms() if value
    ]  # fmt: skip


def test_terms_are_those_of_sympy():
    domain, *generators = ring(NAMES, QQ)
    pairs = [*zip(generators, variables(NAMES), strict=True)]
    pairs += [
        (sum(generators) / 3 + 1, sum(variables(NAMES)) / 3 + 1),
        (domain(0), PackedPolynomial.constant(NAMES, 0)),
    ]
    random = Random(1)
    for _ in range(300):
        (a, packed_a), (b, packed_b) = random.choices(pairs, k=2)
        above, below, power = random.randint(-4, 4), random.randint(1, 6), random.randint(1, 2)
        number = Fraction(above, below)
        exact, constant = QQ(above, below), PackedPolynomial.constant(NAMES, number)
        pairs.append(random.choice([
            (a + b, packed_a + packed_b), (a - b, packed_a - packed_b), (a * exact + b, packed_a * number + packed_b),
            (exact - a, constant - packed_a), (2 - a, 2 - packed_a), (1 + a, 1 + packed_a), (-a, -packed_a),
            (a / below, packed_a / below), *([(a / exact, packed_a / constant)] if above else []),
            *([(a * b, packed_a * packed_b)] if len(a) * len(b) < 200 else []),
            *([(a**power, packed_a**power)] if len(a) < 12 else []),
        ]))  # fmt: skip
        one, packed = pairs[-1]
        assert packed.terms() == terms_of(one) and len(packed) == len(terms_of(one))
    assert max(len(one) for one, _ in pairs) > 8


def test_what_is_no_polynomial_or_too_high_is_refused():
    x, *_ = variables(NAMES)
    with pytest.raises(ZeroDivisionError):
        x / 0
    with pytest.raises(TypeError, match="expected a number as the divisor"):
        x / (x + 1)
    with pytest.raises(OverflowError, match="a degree below"):
        x ** (2**64)
