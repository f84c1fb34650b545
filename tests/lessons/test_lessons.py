"""Lessons: every link leads somewhere, every mistake is refuted, every number is what the motion of the scene has."""

import os
import re
import subprocess
import sys
from dataclasses import replace

import pytest
from sympy import Rational, sqrt

from symrot import check, propagator, symbols
from symrot.catalogue import derivation, names
from symrot.errors import InputError
from symrot.exercises.templates import TOPICS
from symrot.kernels.library import kernel_names
from symrot.lessons.lesson import Mistake, Number
from symrot.lessons.mistakes import mistake_passages, refutation
from symrot.lessons.numbers import numbers_of, value_of
from symrot.lessons.page import APPENDIX, appendix, taught
from symrot.lessons.scene_values import scene_values
from symrot.lessons.table import LESSONS
from symrot.proof.notation.printer import formula
from symrot.proof.page import Figure, Section
from symrot.scene.file import shipped_names
from symrot.scene.scene import load_scene
from symrot.workshop.derivation_pages import illustrated

pytestmark = pytest.mark.first  # the lessons need the derivations that the tests of the catalogue have made


def test_every_derivation_has_a_lesson():
    assert list(LESSONS) == list(names())


def test_what_a_lesson_names_exists():
    for name, lesson in LESSONS.items():
        assert lesson.question.endswith("?"), name
        assert set(lesson.before) <= set(names()) - {name}, name
        assert lesson.scene == "" or lesson.scene in shipped_names(), name
        assert lesson.kernel == "" or lesson.kernel in kernel_names(), name
        assert lesson.topic in TOPICS, name
        assert bool(lesson.numbers) != bool(lesson.worked), name
        assert not lesson.numbers or lesson.scene, name


def test_what_is_needed_before_has_no_circle():
    reached: set[str] = set()
    while new := {name for name in names() if name not in reached and set(LESSONS[name].before) <= reached}:
        reached |= new
    assert reached == set(names())


@pytest.mark.thinned(4)
@pytest.mark.parametrize("name", names())
def test_a_mistake_is_refuted_and_its_repair_is_true(name):
    mistake = LESSONS[name].mistake
    verdict = refutation(mistake)
    assert verdict.counterexample is not None
    if mistake.repair is not None and verdict.repairs:
        repaired = verdict.repairs[mistake.repair].text
        assert check(repaired, assume=mistake.facts, repair=False).verdict == "true", repaired


def test_a_true_formula_is_no_mistake():
    with pytest.raises(InputError, match="a mistake that the checker refutes"):
        refutation(Mistake("It is right.", "sin(x)**2 + cos(x)**2 == 1"))


def test_a_number_without_a_step_or_a_symbol_without_a_value_is_refused():
    page = derivation("kinetic_energy")
    with pytest.raises(InputError, match="first words of a claim on this page"):
        value_of(page, Number("Energy:", "T", "No such", "J"), "t_handle")
    with pytest.raises(InputError, match="no value for dphi, dpsi, dtheta"):
        value_of(page, Number("Energy:", "T", "With two equal moments", "J"), "heavy_top_loops")
    with pytest.raises(InputError, match="the index of one entry as `entry`"):
        value_of(page, Number("Momentum:", "L", "The gradient", "kg m^2/s"), "t_handle")


def number(name, place=0):
    lesson = LESSONS[name]
    return float(value_of(derivation(name), lesson.numbers[place], lesson.scene)[1])


def test_numbers_are_those_of_the_motion():
    """The references come from the propagated motions, not from the derivations."""
    handle = propagator("t_handle")()
    assert number("kinetic_energy") == pytest.approx(handle.energy[0], rel=1e-12)
    assert number("kinetic_energy", 1) == pytest.approx(handle.angular_momentum_body[0][2], rel=1e-12)
    satellite = propagator("axisymmetric_satellite")
    precession = [angles[0] for angles in satellite([0.0, 1.0]).euler("ZXZ")]
    assert number("symmetric_top") == pytest.approx(precession[1] - precession[0], rel=1e-9)
    assert number("driven_rotation") == pytest.approx(propagator("spin_up")([0.0, 100.0]).omega[1][2], rel=1e-9)
    top = propagator("heavy_top_loops")
    assert number("sleeping_top") == pytest.approx(
        float(sqrt(4 * Rational(str(top.plan.scene.body.inertia[0][0])) * Rational("4.905") * Rational("0.06")))
        / float(top.plan.scene.body.inertia[2][2]), rel=1e-12)  # fmt: skip


def test_a_disturbance_of_the_handle_grows_at_the_rate_of_the_lesson():
    """Over a time in which the disturbance stays small: cosh at that rate."""
    from math import cosh

    motion = propagator("t_handle")([0.0, 0.2])
    first, last = motion.omega[0][0], motion.omega[1][0]
    assert last / first == pytest.approx(cosh(0.2 * number("intermediate_axis")), rel=1e-4)


def test_the_frequency_of_jacobi_is_that_of_small_swings():
    """Near the axis of the largest moment the motion is the small swing of the page on the intermediate axis."""
    values = scene_values(load_scene("tumbling_prism_largest"))
    low, middle, high = (values[symbols.A], values[symbols.B], values[symbols.C])
    swing = sqrt((high - low) * (high - middle) / (low * middle)) * values[symbols.omega_3]
    assert number("free_asymmetric_body") == pytest.approx(float(swing), rel=1e-3)


def test_printed_numbers_follow_from_the_printed_constants():
    """A formula may be a difference of nearly equal numbers: the constants have the digits that it needs."""
    for name, lesson in LESSONS.items():
        if not lesson.numbers:
            continue
        page, lines = derivation(name), list(numbers_of(derivation(name), lesson))
        constants = {symbol: printed(rf"\${re.escape(formula(symbol))} = ", lines[0].text) for symbol in symbols.UNIT}
        constants = {symbol: value for symbol, value in constants.items() if value is not None}
        for entry, line in zip(lesson.numbers, lines[1:], strict=True):
            expression, _ = value_of(page, entry, lesson.scene)
            assert expression.free_symbols <= set(constants), (name, expression)
            value = printed("(?:^|= )", line.equations[0][1].split(" = ")[-1])
            assert complex(expression.subs(constants)) == pytest.approx(value, rel=2e-3, abs=1e-12), (name, line)


def printed(before, text):
    """Return the number that follows ``before`` in the LaTeX of a page, or None."""
    match = re.search(rf"{before}(-?[\d.]+)( \\cdot 10\^\{{(-?\d+)\}})?", text)
    return float(f"{match[1]}e{match[3] or 0}") if match else None


@pytest.mark.parametrize("name", ["poinsot", "rolling", "elliptic_functions", "planar_linkages"])
def test_a_page_opens_with_a_question_and_closes_with_where_to_go_on(name):
    page = illustrated(derivation(name))
    assert LESSONS[name].question in page.opening[0].text
    assert [item for item in page.opening if isinstance(item, Figure)]
    assert [item.title for item in page.closing if isinstance(item, Section)] == [
        "With numbers", "A common mistake", "Go on",
    ]  # fmt: skip
    assert f"symrot exercise {LESSONS[name].topic}" in page.closing[-1].text
    html, latex = page.html(), page.latex()
    assert html.index("<figure>") < html.index('class="step"') < html.index("A common mistake")
    assert latex.index("You need before") < latex.index(r"\paragraph{1.}") < latex.index("A common mistake")


def test_the_command_that_a_page_prints_checks_the_claim():
    passages = list(mistake_passages(LESSONS["parallel_axis"].mistake))
    command = re.search(r"`(symrot check .*)`", passages[-1].text)[1]
    assert command.count("--given") == len(LESSONS["parallel_axis"].mistake.facts)


@pytest.mark.campaign  # the pages in derivations/ end with lessons, and are printed here with another hash seed each time
def test_a_lesson_does_not_depend_on_hashing():
    program = (
        "import sys; from symrot.catalogue import derivation; from symrot.lessons.page import taught;"
        "sys.stdout.write(repr([taught(derivation(name)).closing for name in sys.argv[1:]]))"
    )
    chosen = ["kinetic_energy"]
    environment = os.environ | {"PYTHONHASHSEED": "20"}
    command = [sys.executable, "-c", program, *chosen]
    text = subprocess.run(command, env=environment, capture_output=True, check=True, text=True).stdout
    assert text == repr([taught(derivation(name)).closing for name in chosen])


def test_a_section_for_the_library_must_exist(monkeypatch):
    page = derivation("driven_rotation")
    monkeypatch.setitem(LESSONS, "driven_rotation", replace(LESSONS["driven_rotation"], library=("No such",)))
    with pytest.raises(InputError, match=r"the titles of the last sections of the page, in order, got \['No such'\]"):
        taught(page)


def test_an_appendix_has_the_steps_that_the_lesson_leaves_out():
    for name in names():
        page = derivation(name)
        lesson, rest = taught(page), appendix(page)
        assert (rest is not None) == bool(LESSONS[name].library)
        steps = lesson.steps + (rest.steps if rest else ())
        assert list(map(id, steps)) == list(map(id, page.steps))
        links = [item.text for item in lesson.opening if f"({name}{APPENDIX}.md)" in item.text]
        assert len(links) == (rest is not None)
        if rest:
            assert rest.first == len(lesson.steps) + 1 and f"]({name}.md)" in rest.about
            assert re.search(rf"tep(s {rest.first} (to|and) {len(page.steps)}| {rest.first}), which only", links[0])


def test_only_the_last_sections_can_be_for_the_library(monkeypatch):
    monkeypatch.setitem(LESSONS, "poinsot", replace(LESSONS["poinsot"], library=("The polhode",)))
    with pytest.raises(
        InputError, match=r"last sections of the page, in order, got \['The polhode'\]; .*'The herpolhode'\]"
    ):
        appendix(derivation("poinsot"))
