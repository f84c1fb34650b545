"""The rates of one vector seen from two frames, in the notations of books: true with the right sign, never false."""

import pytest

import symrot

B = r"\boldsymbol\omega"


@pytest.mark.parametrize("text", [
    "dA/dt = d'A/dt + Ω×A", "(dA/dt)_s = (dA/dt)_b + ω × A", "(dr/dt)_fixed = (dr/dt)_rot + ω × r",
    "(dA/dt)_space = (dA/dt)_body + w x A",
    rf"\left.\frac{{d\mathbf A}}{{dt}}\right|_I = \left.\frac{{d\mathbf A}}{{dt}}\right|_B + {B}\times\mathbf A",
    rf"\left(\frac{{d\mathbf L}}{{dt}}\right)_{{\text{{space}}}} = \left(\frac{{d\mathbf L}}{{dt}}\right)_{{\text{{body}}}} + {B}\times\mathbf L",
    rf"\frac{{{{}}^N d}}{{dt}}\mathbf v = \frac{{{{}}^B d}}{{dt}}\mathbf v + {{}}^N{B}^B\times\mathbf v",
    rf"{{}}^N\frac{{d}}{{dt}}\mathbf r = {{}}^B\frac{{d}}{{dt}}\mathbf r - {B}_{{N/B}}\times\mathbf r",
    r"\dot{\vec A} = \mathring{\vec A} + \vec\omega\times\vec A",
    rf"\left(\frac{{d}}{{dt}}\right)_I = \left(\frac{{d}}{{dt}}\right)_B + {B}\times",
])  # fmt: skip
def test_the_transport_theorem_is_true_as_books_write_it(text):
    verdict = symrot.check(text)
    assert verdict.verdict == "true"
    assert any("is the angular velocity of" in note for note in verdict.notes)


def test_with_the_other_sign_the_angular_velocity_is_that_of_the_fixed_frame():
    verdict = symrot.check("(dA/dt)_I = (dA/dt)_B - ω × A")
    assert verdict.verdict == "conditional"
    assert verdict.requires == ("omega is the angular velocity of the frame I relative to the frame B",)


@pytest.mark.parametrize("text", [
    "(dA/dt)_I = (dA/dt)_B + 2 ω × A",
    rf"{{}}^N\frac{{d}}{{dt}}\mathbf r = {{}}^B\frac{{d}}{{dt}}\mathbf r + {B}_{{N/B}}\times\mathbf r",
])  # fmt: skip
def test_another_factor_or_a_marked_direction_that_does_not_fit_is_false(text):
    assert symrot.check(text).verdict == "false"


def test_one_rate_with_the_mark_of_a_frame_is_read_without_it():
    verdict = symrot.check("(dL/dt)_s = τ")
    assert verdict.verdict == "recognised"
    assert "the label s for the frame of a derivative is ignored" in verdict.notes
