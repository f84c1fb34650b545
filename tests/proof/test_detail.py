"""A step in detail: the proof on the board is proven too, components fill a screen at most, and reasons stand once."""

import pytest
from sympy import Matrix, acos, asin, cos, pi, sin

from symrot.catalogue import derivation
from symrot.proof.derivation import Derivation, ProofError
from symrot.proof.page import Section
from symrot.proof.pages.parts import MANY, remarks, repetitions
from symrot.symbols import omega_b, theta, x

pytestmark = pytest.mark.first  # these tests need the derivations that the tests of the catalogue have made

OMEGA = Matrix(omega_b)
LONGEST = 33  # lines of LaTeX: a screen


@pytest.fixture
def page():
    d = Derivation("page", title="A page", source="Nobody", about="About.")
    d.notation({"v": Matrix([sin(x), cos(x), 0]), r"\omega": OMEGA})
    return d


def test_the_board_is_shown_instead_of_components(page):
    step = page.step("Zero.", OMEGA.dot(OMEGA.cross(OMEGA)), 0, because="of it", named="z",
                     board=[("Perpendicular:", r"\omega \cdot (\omega \times \omega)"), ("Hence:", "0")])  # fmt: skip
    assert len(step.board) == 2
    text = page.part(1, True).markdown()
    assert r"z = \omega \cdot (\omega \times \omega)" in text and "\n= 0" in text and "normal form" not in text[:200]


@pytest.mark.parametrize("wrong", [r"\omega \cdot \omega", "1"])
def test_a_wrong_line_on_the_board_is_refused(page, wrong):
    with pytest.raises(ProofError, match="does not hold"):
        page.step("Zero.", OMEGA.dot(OMEGA.cross(OMEGA)), 0, because="of it", board=[("Wrong:", wrong)])


def test_a_line_on_the_board_that_cannot_be_read_is_refused(page):
    with pytest.raises(ProofError, match=r"in the detailed proof of the step, got \\text"):
        page.step("Zero.", OMEGA.dot(OMEGA.cross(OMEGA)), 0, because="of it", board=[("Words:", r"\text{nothing}")])


def lines_in_detail(name, number):
    detail = derivation(name).part(number, True).latex().split(r"\section*{In detail}")[1]
    return detail.split(r"\paragraph{Units}")[0].split(r"\medskip")[0].strip().count("\n") + 1


@pytest.mark.parametrize(
    "name, number",
    [
        ("euler_equations", 1), ("euler_equations", 2), ("euler_equations", 6), ("composition", 2), ("spin_tensor", 5),
        ("axis_and_angle", 5), ("kinetic_energy", 6), ("parallel_axis", 1), ("free_body_invariants", 2),
        ("angular_momentum", 5), ("gravity_gradient", 4), ("poinsot", 2), ("planar_motion", 6), ("gyrostat_invariants", 1),
        ("heavy_top_invariants", 1), ("elliptic_functions", 7), ("free_body_separatrix", 5), ("rodrigues", 11),
    ],
)  # fmt: skip
def test_a_step_in_detail_fits_on_a_screen(name, number):
    assert lines_in_detail(name, number) <= LONGEST


def test_what_does_not_fit_is_said_to_be_left_out():
    assert "is left out" in derivation("composition").part(2, True).markdown()
    assert "is left out" not in derivation("intermediate_axis").part(2, True).markdown()


def test_many_alike_steps_have_one_reason():
    body_rates = derivation("euler_body_rates")
    repeated = repetitions(body_rates)
    assert len(repeated) == len(body_rates.steps) - 6
    assert not {1, 2, 3, 4, 5, 6} & repeated
    assert repetitions(derivation("intermediate_axis")) == frozenset()


def test_a_step_that_differs_keeps_its_reason(page):
    for number in range(MANY):
        page.section(f"Case {number}")
        page.step("It is one.", sin(theta) ** 2 + cos(theta) ** 2, 1, because="sine and cosine are on the circle")
    page.step("It is one.", cos(0), 1, because="the cosine of zero is one")
    assert repetitions(page) == frozenset(range(2, MANY + 1))
    text = page.markdown()
    assert text.count("*Why:*") == 2 and isinstance(page.items[0], Section)
    assert [*remarks(page.steps[0], True)] == []


def test_a_step_that_rewriting_does_not_prove_says_so_in_detail():
    """Sums of inverse functions are proven without normal forms; the page ended with an exception of Python."""
    page = Derivation("sums", title="Sums")
    page.step("The angles are complementary:", asin(x) + acos(x), pi / 2, because="both are angles of one triangle")
    assert "proven equal by another method" in page.part(1, detail=True).markdown()
