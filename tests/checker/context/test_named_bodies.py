"""Names of moments of inertia that say the body or the point, as ``I_rod`` and ``I_end``."""

import pytest

import symrot


@pytest.mark.parametrize(("text", "name"), [
    ("I_rod = m l²/12", "rod"), ("I_disc = 1/2 m r²", "disk"), ("I_end = 1/3 M L²", "rod about an end"),
    ("I_end = 1/4 M R² + 1/3 M L²", "cylinder about the centre of an end"), ("I_shell = 2/3 m r²", "spherical shell"),
    ("I_rod_center = 1/12 M L²", "rod about its centre"), ("I_{cm} = \\frac{2}{5} m r^2", "sphere about its centre"),
    ("I_cone_tip = 3/5 m h² + 3/20 m r²", "cone about its tip"),
])  # fmt: skip
def test_the_formula_of_the_body_and_point_in_a_name_is_recognised(text, name):
    verdict = symrot.check(text)
    assert verdict.verdict == "recognised" and all(name in known.name for known in verdict.recognised_as)


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("text", "repaired"), [
    ("I_G = 3/2 m r²", "I_G = m*r^2/2"), ("I_end = 1/12 M L²", "I_end = M*L^2/3"),
    (r"I_{end} = \frac12 M L^2", "I_{end} = M \\frac{L^2}{3}"),
    ("I_rod_end = 1/2 M L²", "I_rod_end = M*L^2/3"), ("I_rod_center = 1/3 M L²", "I_rod_center = M*L^2/12"),
    ("I_cm = 1/3 M L²", "I_cm = M*L^2/12"),
    ("I_sphere = 1/2 m r²", "I_sphere = 2*m*r^2/5"), ("I_rod = m l²/2", "I_rod = m*l^2/12"),
    ("I_disk = 1/3 m r²", "I_disk = m*r^2/4"),
])  # fmt: skip
def test_the_formula_of_another_body_or_point_is_doubtful(text, repaired):
    verdict = symrot.check(text)
    assert verdict.verdict == "doubtful" and verdict.repairs[0].text == repaired


@pytest.mark.parametrize(("text", "letter"), [("I_G = 1/3 m l²", "l"), ("I_end = 4/3 m a²", "a")])
def test_some_books_take_a_letter_for_half_the_length_of_a_rod(text, letter):
    verdict = symrot.check(text)
    assert verdict.verdict == "recognised" and verdict.notes[-1] == f"guessed, not stated: {letter} is half the length"


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    ("text", "body"), [("I = 7/48 m L²", "rod"), ("I = 3/4 m r²", "disk"), ("I_disk = 3/4 m r²", "")]
)
def test_a_moment_about_a_parallel_axis_is_not_doubtful(text, body):
    assert symrot.check(text, body=body).verdict == "definition"
