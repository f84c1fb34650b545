"""Plain text as it is copied from lectures and posts: heads, both signs, lost raised digits, accents before letters."""

import pytest

from symrot.checker.claim.reader import readings_of
from symrot.checker.claim.tree import text
from symrot.checker.typed.copied_text import without_surroundings
from symrot.checker.typed.tokens import tokens_of

COPIED = (
    ("f(x) = x²", ["f == x**2"]), ("R(φ) = [[c, φ], [1, 0]]", ["R == Matrix([[c, phi], [1, 0]])"]),
    ("a(x, y) = x + y", ["a == x + y"]), ("x = a ± b ∓ c", ["x == a + b - c", "x == a - b + c"]),
    ("ω_± = ± k", ["omega_plus == k", "omega_minus == -k"]), ("I′ᵢₖ = Iᵢₖ", ["diff(I_ik(t), t) == I_ik(t)"]),
    ("˙φ = ω", ["diff(phi(t), t) == omega"]), ("φ˙ = ω", ["diff(phi(t), t) == omega"]), ("y = sin2 θ + x2", ["y == sin(theta)**2 + x2"]),
    ("[q~] = A", ["skew(q) == A"]), ("A† = B", ["A.T == B"]), ("q* = p", ["conjugate(q) == p"]), ("q v q^* = p", ["q*v*conjugate(q) == p"]),
    ("2*a = b*3", ["2*a == b*3"]), ("a = 2*-b", ["a == -2*b"]), ("v = S(ω) r", ["v == skew(omega)*r"]),
)  # fmt: skip


@pytest.mark.parametrize(("typed", "full"), COPIED)
def test_copied_text_is_read(typed, full):
    lines = readings_of(typed)[0].lines
    assert [" == ".join(map(text, chain.sides)) for chain in lines] == full


def test_a_lost_raised_digit_has_two_readings():
    first, *others = readings_of("sin2 θ = x")
    assert text(first.relation[1]) == "sin(theta)**2"
    assert "sin(2*theta)" in [text(other.relation[1]) for other in others]
    assert text(readings_of("sin2θ = x")[0].relation[1]) == "sin(2*theta)"


def test_every_place_of_a_token_is_a_place_of_the_text():
    source = "˙φ = I′ᵢₖ + ‖q‖ ± x"
    assert all(0 <= token.start <= token.end <= len(source) for token in tokens_of(source))


@pytest.mark.parametrize(("source", "rest"), [
    ("x = y  (2.1)", "x = y"), ("x = y + (2.1)", "x = y + (2.1)"), ("x = y (Steiner)", "x = y"), ("x = (y) + (dist)", "x = (y) + (dist)"),
    ("x = y (dpsi)", "x = y (dpsi)"), ("x = (Omega)", "x = (Omega)"), ("x = y - (1.5)", "x = y - (1.5)"), ("x = y * (velocity)", "x = y * (velocity)"),
])  # fmt: skip
def test_brackets_after_an_operator_are_a_part_of_the_formula(source, rest):
    assert without_surroundings(source).text.rstrip() == rest
