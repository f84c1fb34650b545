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


@pytest.mark.parametrize("answer", [
    "2 phi_dot = mgh/(C omega_3)", "1/φ̇ = mgh/(C ω_3)", "-dphi = mgh/(C omega_3)", "φ̇² = mgh/(Cω_3)", "tan(dphi) = mgh/(C omega_3)",
    "phi_dot != mgh/(C omega_3)", "dphi >= mgh/(C omega_3)", "C = mgh/(C omega_3)", r"2\dot\phi = \frac{mgh}{C\omega_3}", "mgh/C = mgh/(C omega_3)",
])  # fmt: skip
def test_an_equation_for_something_else_is_not_right(answer):
    """A right formula after the name of twice the quantity says that the quantity is half of it."""
    mark = symrot.grade(symrot.exercise("level_precession")[0], [answer]).marks[0]
    assert mark.outcome == "unread" and mark.credit == 0 and "in front of '='" in mark.text, mark


@pytest.mark.parametrize("template, left, key", [
    ("level_precession", "dphi/dt", "a"), ("level_precession", r"\frac{d\phi}{dt}", "a"), ("level_precession", "phi-dot", "a"), ("level_precession", "Ω_p", "a"),
    ("level_precession", "m h g/(omega_3 C)", "a"), ("acceleration_at_dead_centre", "d²x/dt²", "a"), ("acceleration_at_dead_centre", r"\frac{d^2 x}{dt^2}", "a"),
    ("polhode_constants", "ω₃²", "a"), ("polhode_constants", r"\omega_3^2", "a"), ("relative_rotation", "cos α", "a"), ("angle_between", "cos(α/2)", "a"),
    ("angle_between", r"\cos\frac{\alpha}{2}", "a"), ("only_sum_of_angles", "R(1,1)", "a"), ("speed_of_rotation", "|ω|", "a"), ("determinant", "det B", "a"),
    ("polhode_constants", "ω₃²", "b"), ("angle_between", "cos(α/2)", "b"), ("level_precession", "9.81/9.81 · 2 rad/s", "b"), ("rod_about_end", "m L²/3", "b"),
    ("rod_about_end", "3/4", "b"), ("speed_of_rotation", "60 rpm", "b"), ("speed_of_rotation", "|ω| ≈ 60 rpm", "b"),
])  # fmt: skip
def test_the_name_of_the_quantity_may_stand_in_front(template, left, key):
    exercise = symrot.exercise(template)[0]
    question = next(each for each in exercise.questions if each.key == key)
    answer = question.answer if key == "a" else f"{question.decimal} {question.unit}"
    mark = next(each for each in symrot.grade(exercise, {key: f"{left} = {answer}"}) if each.key == key)
    assert mark.outcome == "right", mark


@pytest.mark.parametrize("answer", ["2 I = 4 kg m^2", "1/I_O = 4 kg m^2", "-I = 4 kg m^2", "I/2 = 4 kg m²", "I² = 4 kg m^2", "5 >= 4 kg m^2", "3 != 4 kg m^2", r"I \ne 4 kg m^2"])  # fmt: skip
def test_a_number_for_something_else_is_not_right(answer):
    mark = symrot.grade(ROD, {"b": answer}).marks[1]
    assert mark.outcome == "unread" and mark.credit == 0, mark


@pytest.mark.parametrize("answer", ["4·10⁰ kg m²", "4000·10⁻³ kg m²", "0.04 · 10² kg·m²", "4 N m s²", "4.02 kg m^2", "3.98 kg m^2"])  # fmt: skip
def test_powers_may_be_written_with_raised_digits(answer):
    assert symrot.grade(ROD, {"b": answer}).marks[1].outcome == "right"


@pytest.mark.parametrize("template, answer", [
    ("level_precession", "mgh/Cω₃"), ("level_precession", "mgh/ω₃C"), ("level_precession", "mgh/Comega_3"), ("level_precession", "{mgh}/{C omega_3}"),
    ("period_of_rod", "2π√(2L/(3g))"), ("period_of_rod", "√(8π²L/(3g))"),
])  # fmt: skip
def test_letters_written_together_divide_together(template, answer):
    """Without Greek letters, mgh/CL already divided by both C and L."""
    mark = symrot.grade(symrot.exercise(template)[0], [answer]).marks[0]
    assert mark.outcome == "right", mark


@pytest.mark.parametrize("answer", [
    "atan2(A ω_1, C ω_3)", "arccos(C ω_3/√(A²ω_1² + C²ω_3²))", "arcsin(A ω_1/√(A²ω_1² + C²ω_3²))", "π/2 - arctan(C ω_3/(A ω_1))",
])  # fmt: skip
def test_formulas_are_equal_if_they_are_for_all_numbers_of_the_exercise(answer):
    """All rates of this template are positive, so that these formulas give the same angle."""
    mark = symrot.grade(symrot.exercise("angle_of_momentum")[0], [answer]).marks[0]
    assert mark.outcome == "right", mark
    wrong = symrot.grade(symrot.exercise("angle_of_momentum")[0], [answer.replace("ω_3", "ω_1")]).marks[0]
    assert wrong.outcome == "wrong", wrong
