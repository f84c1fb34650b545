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


@pytest.mark.parametrize("context", [
    'where = ["I_xy = product of inertia without the minus sign"]', 'body = "solid cylinder with the symmetry axis x"',
])  # fmt: skip
def test_a_worked_number_is_decided_beside_a_context_that_changes_equations(tmp_path, context):
    file = tmp_path / "claims.toml"
    claim = '[[claim]]\nid = "a"\nsymbols = []\nvalue = "2*pi"\nprinted_value = "6.28"'
    file.write_text(f"schema = 1\n{claim}\n{context}\n")
    assert [verdict.verdict for verdict in symrot.check_file(file)] == ["true"]
