"""Both signs of products of inertia: a definition by an integral says which, and otherwise a note does."""

from fractions import Fraction

import pytest

import symrot

PLUS, MINUS = "I_xy = ∫xy dm", r"I_{xy} = -\int xy\,dm"


@pytest.mark.parametrize(("definition", "sign", "verdict"), [
    (PLUS, "-", "true"), (PLUS, "+", "false"), (MINUS, "+", "true"), (MINUS, "-", "false"),
])  # fmt: skip
def test_a_hypothesis_states_the_sign(definition, sign, verdict):
    assert (
        symrot.check(f"H_x = I_xx ω_x {sign} I_xy ω_y {sign} I_xz ω_z", assume=[definition], repair=False).verdict
        == verdict
    )


@pytest.mark.parametrize(("sign", "verdict"), [("-", "recognised"), ("+", "false")])
def test_a_line_states_the_sign(sign, verdict):
    text = f"I_xy = ∫xy dm; H_x = I_xx ω_x {sign} I_xy ω_y {sign} I_xz ω_z"
    assert symrot.check(text, repair=False).verdict == verdict


@pytest.mark.parametrize(("sign", "words"), [("+", "with the minus sign"), ("-", "without the minus sign")])
def test_the_convention_is_told(sign, words):
    verdict = symrot.check(f"H_x = I_xx ω_x {sign} I_xy ω_y {sign} I_xz ω_z")
    assert any(words in text for text in (*verdict.notes, *(known.how for known in verdict.recognised_as)))


NAMES_ABOUT_THE_CENTRE = [
    "I_{xy,G}", "I_{xyG}", r"\bar{I}_{xy}", "I_{x'y'}", "I_{x_c y_c}", "I_{xy}^G", "I_{xy}^{(G)}", r"I_{xy}^{\text{cm}}",
]  # fmt: skip


def _products(sign):
    """Return the product of inertia of three point masses about the origin, that about their centre, and m a b."""
    masses, points = (1, 2, 3), ((1, 5), (-2, 1), (4, -3))
    total = sum(masses)
    a, b = (Fraction(sum(m * point[axis] for m, point in zip(masses, points, strict=True)), total) for axis in (0, 1))

    def about(p, q):
        return sign * sum(m * (x - p) * (y - q) for m, (x, y) in zip(masses, points, strict=True))

    return about(0, 0), about(a, b), total * a * b


@pytest.mark.parametrize("name", NAMES_ABOUT_THE_CENTRE)
@pytest.mark.parametrize("definition", [1, -1])
@pytest.mark.parametrize("sign", [1, -1])
def test_parallel_axes_have_the_sign_of_the_definition(name, definition, sign):
    """``I_xy = I_xyG + m a b`` holds for I_xy = ∫xy dm, about O and about G, and with ``-`` for I_xy = -∫xy dm."""
    about_origin, about_centre, shift = _products(definition)
    where = [f"I_xy = {'-' * (definition < 0)}integral of x y dm"]
    verdict = symrot.check(f"I_{{xy}} = {name} {'+' if sign > 0 else '-'} m a b", where=where)
    holds = about_origin == about_centre + sign * shift
    assert (verdict.verdict in ("true", "recognised")) == holds
    assert verdict.verdict in ("recognised", "true", "false", "doubtful")


def test_primed_axes_make_one_name():
    assert symrot.check("I_x'y' = I_xy + m a b").verdict == "recognised"


@pytest.mark.parametrize("context", [
    'where = ["I_xy = product of inertia without the minus sign"]', 'body = "solid cylinder with the symmetry axis x"',
])  # fmt: skip
def test_a_worked_number_is_decided_beside_a_context_that_changes_equations(tmp_path, context):
    file = tmp_path / "claims.toml"
    claim = '[[claim]]\nid = "a"\nsymbols = []\nvalue = "2*pi"\nprinted_value = "6.28"'
    file.write_text(f"schema = 1\n{claim}\n{context}\n")
    assert [verdict.verdict for verdict in symrot.check_file(file)] == ["true"]
