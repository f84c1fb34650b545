"""Grading: right in every form, wrong answers never right, and the kind of error named."""

from fractions import Fraction

import pytest

import symrot

ROD = symrot.exercise("rod_about_end", seed=0)[0]  # m = 3 kg, L = 2 m: 4 kg m^2


@pytest.mark.parametrize("answer", [
    "m*L**2/3", "m L^2/3", "mL²/3", "1/3 m L^2", "m*(L/2)^2 + m*L^2/12", "I_O = m*L^2/3", r"\frac{1}{3} m L^2", r"$I_O = \frac{m L^2}{3}$",
    "(m L)^2/(3 m)", "L^2/(3/m)",
])  # fmt: skip
def test_a_formula_is_right_in_every_form(answer):
    (mark, _) = symrot.grade(ROD, [answer])
    assert mark.outcome == "right" and mark.credit == 1, mark


@pytest.mark.parametrize("answer, code", [
    ("m*L^2/6", "factor"), ("-m*L^2/3", "overall_sign"), ("m*L/3", "exponent"), ("3/(m*L^2)", "inverse"), ("L*m^2/3", "exchanged"),
    (r"\frac{m L^2}{6}", "factor"),
])  # fmt: skip
def test_a_wrong_formula_gets_part_of_the_credit_and_its_error_is_named(answer, code):
    (mark, _) = symrot.grade(ROD, [answer])
    assert mark.outcome == "wrong" and mark.code == code and mark.credit < 1 and mark.text, mark


@pytest.mark.parametrize("answer", ["4 kg m^2", "4.00 kg*m^2", "4e0 kg m²", "40000 kg cm^2", r"4\,\mathrm{kg\,m^2}", "8/2 kg m^2", "I_O = 4.0 kg m^2", "4,00 kg m^2", "4 N m s^2", "sqrt(16) kg m^2"])  # fmt: skip
def test_a_number_is_right_in_other_units_and_ways(answer):
    mark = symrot.grade(ROD, {"b": answer}).marks[1]
    assert mark.outcome == "right", mark


@pytest.mark.parametrize("answer, code", [
    ("4", "unit_forgotten"), ("-4 kg m^2", "sign"), ("8 kg m^2", "factor"), ("4000 kg m^2", "power_of_ten"), ("4 kg", "dimension"),
    ("0.25 kg m^2", "inverse"), ("4.3 kg m^2", "other"),
])  # fmt: skip
def test_a_wrong_number_is_told_what_is_wrong(answer, code):
    mark = symrot.grade(ROD, {"b": answer}).marks[1]
    assert mark.outcome == "wrong" and mark.code == code and mark.credit < 1 and mark.text, mark


def test_next_to_an_angle_a_hertz_is_one_rotation_per_second():
    exercise = symrot.exercise("body_rates")[0]
    question = next(each for each in exercise.questions if each.kind == "number")
    for text, outcome in (
        (f"{float(question.decimal) / 6.283185307} Hz", "right"),
        (f"{question.decimal} Hz", "wrong"),
    ):
        mark = next(each for each in symrot.grade(exercise, {question.key: text}) if each.key == question.key)
        assert mark.outcome == outcome, mark


@pytest.mark.parametrize(
    "key, answer", [("a", "m*L^2/"), ("a", "m*l^2/3"), ("a", "a = b = c"), ("b", "four"), ("b", "4 parsec")]
)
def test_what_cannot_be_read_gets_no_credit_and_a_sentence(key, answer):
    mark = next(mark for mark in symrot.grade(ROD, {key: answer}) if mark.key == key)
    assert mark.outcome == "unread" and mark.credit == Fraction(0) and mark.text.startswith("expected"), mark


@pytest.mark.parametrize("template, answer", [
    ("only_sum_of_angles", r"\cos(\phi+\psi)"), ("only_sum_of_angles", "cos φ cos ψ − sin φ sin ψ"), ("level_precession", "mgh/(C ω_3)"),
    ("level_precession", r"\frac{m g h}{C \omega_3}"), ("component_of_rotation", "sin(α/2)"), ("separatrix_momentum", "sqrt(2 T B)"),
])  # fmt: skip
def test_letters_may_be_greek_latex_or_written_together(template, answer):
    mark = symrot.grade(symrot.exercise(template)[0], [answer]).marks[0]
    assert mark.outcome == "right", mark


@pytest.mark.parametrize(
    "answer, credit", [("0", 0), ("4", 0), ("m", Fraction(1, 4)), ("L^2/3", Fraction(1, 4)), ("m L^2", Fraction(1, 2))]
)
def test_a_fragment_of_the_answer_gets_little_credit(answer, credit):
    """Any two products differ by a factor, so that the diagnosis alone would give half of the credit for a letter."""
    assert symrot.grade(ROD, [answer]).marks[0].credit == credit


@pytest.mark.parametrize("answer", [
    "", "=", "((((", "1/0", "{}", r"\frac{", "m" * 2000, "L**999999", "2^2^2^2^2^2", "sqrt(-m)", "nan", "1e999", "\0", "m\nL", "4 %",
    "__import__('os')", "\N{GRINNING FACE}", "1.0e308 kg km^2", "-1.0e308 kg km^2", "1e308 kg km^2", "5e-324 kg m^2",
    "m " * 990,
])  # fmt: skip
def test_hostile_answers_get_a_mark_and_no_credit(answer):
    for mark in symrot.grade(ROD, [answer, answer]):
        assert mark.outcome in ("unread", "missing", "wrong", "undecided") and mark.credit == 0 and mark.text


@pytest.mark.parametrize("answer", ["4kgm^2", "4 kgm²", "4 kg m^2.", "≈4 kg·m²", r"4~\text{kg m}^2"])
def test_units_may_be_written_as_students_write_them(answer):
    assert symrot.grade(ROD, {"b": answer}).marks[1].outcome == "right"


@pytest.mark.parametrize("answer", [
    "dpsi - dphi*sin(theta)", "psi_dot - phi_dot sin(theta)", "psidot - phidot*sin theta", "ψ̇ − φ̇ sin θ", r"\dot\psi - \dot\phi\sin\theta",
])  # fmt: skip
def test_rates_may_be_written_with_dots_or_as_words(answer):
    exercise = symrot.exercise("body_rates", seed=4)[0]
    assert exercise.questions[0].answer == "-dphi*sin(theta) + dpsi"
    assert symrot.grade(exercise, [answer]).marks[0].outcome == "right"


@pytest.mark.parametrize("template, answer, outcome", [
    ("rate_about_vertical", "ω_z = ((cos(theta))*(dpsi)) + (dphi)", "right"), ("rate_about_vertical", "dphi + cos(theta) (dpsi)", "right"),
    ("rate_about_vertical", "dphi + dpsi*cos(theta) (dphi)", "wrong"), ("rod_about_end", "m*L^2/3 (1.5)", "wrong"), ("rod_about_end", "m*L^2/2 (2/3)", "right"),
    ("rod_about_end", "m*L^2/3 (Steiner)", "unread"), ("rod_about_end", "m*Abs(L)^2/3", "right"), ("rod_about_end", "-|m|*L^2/3", "wrong"),
])  # fmt: skip
def test_a_factor_in_brackets_at_the_end_counts(template, answer, outcome):
    mark = symrot.grade(symrot.exercise(template, seed=0)[0], [answer]).marks[0]
    assert mark.outcome == outcome, mark


def test_names_with_indices_may_have_braces_or_underscores():
    exercise = symrot.exercise("angle_between")[0]
    for answer in ("p_0 q_0 + p_1 q_1 + p_2 q_2 + p_3 q_3", "p_{0} q_{0} + p_{1} q_{1} + p_{2} q_{2} + p_{3} q_{3}"):
        assert symrot.grade(exercise, [answer]).marks[0].outcome == "right"


def test_answers_to_no_question_are_refused():
    with pytest.raises(symrot.InputError, match="expected names among the questions a, b, got 'z'"):
        symrot.grade(ROD, {"z": "1"})


def test_an_inverse_cosine_is_read_as_the_page_prints_it():
    exercise = symrot.exercise("angle_of_two_rotations")[0]
    assert r"\arccos" in exercise.questions[0].latex
    assert symrot.grade(exercise, [exercise.questions[0].latex]).marks[0].outcome == "right"
