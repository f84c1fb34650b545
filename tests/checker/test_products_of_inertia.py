"""Both signs of products of inertia: a definition by an integral says which, and otherwise a note does."""

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


def test_primed_axes_make_one_name():
    assert symrot.check("I_x'y' = I_xy + m a b").verdict == "recognised"
