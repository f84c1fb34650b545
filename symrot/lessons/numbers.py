"""The section "With numbers" of a page: formulas of its steps, evaluated with the numbers of a scene."""

import re
from collections.abc import Iterator
from functools import cache

from sympy import Expr, Float, MatrixBase, factor

from symrot.catalogue import derivation
from symrot.errors import InputError
from symrot.exercises.exercise import Exercise
from symrot.exercises.sheet import exercise
from symrot.exercises.units import unit_latex
from symrot.lessons.lesson import Lesson, Number
from symrot.lessons.scene_values import scene_values
from symrot.proof.notation.printer import formula
from symrot.proof.page import Page, Passage, Section, Step, Table
from symrot.scene.scene import load_scene
from symrot.symbols import UNIT

__all__ = ["numbers_of", "value_of"]

DIGITS = 4  # of results
AGREEMENT = 1e-3  # relative; the results follow from the printed constants to this accuracy
PRECISION = 50  # digits; the scene's own numbers, such as quaternions, have 60
DOUBLE = 16  # digits of a double
NOTHING = 1e-30  # a number below it is zero but for rounding
LONGEST = 300  # letters of LaTeX of a formula that is printed again beside its number


def numbers_of(page: Page, lesson: Lesson) -> Iterator[Passage]:
    """Yield the paragraphs "With numbers" of a page: formulas evaluated for a scene, or an exercise with its
    solution.
    """
    if lesson.numbers:
        yield from _of_scene(page, lesson)
    else:
        yield from _of_exercise(lesson)


def value_of(page: Page, number: Number, scene: str) -> tuple[Expr, Expr]:
    """Return the formula of a number, in symbols that have a value in the scene, and its value to 50 digits.

    Raises
    ------
    InputError
        If no step of the page begins with ``number.step``, if the scene gives no value for a symbol of the formula, if
        the value is not real, or if the formula is a matrix and ``number.entry`` is None.

    Examples
    --------
    >>> number = Number("Energy:", "T", "Along principal axes", "J")
    >>> value_of(derivation("kinetic_energy"), number, "tumbling_prism")[0]
    A*omega_1**2/2 + B*omega_2**2/2 + C*omega_3**2/2
    """
    step = _step(derivation(number.page) if number.page else page, number)
    side = step.right if step.display is None or isinstance(step.display, str) else step.display.doit()
    if isinstance(side, MatrixBase):
        if number.entry is None:
            raise InputError(
                f"{page.name}, {number.words!r}: the formula is a matrix; expected the index of one entry as `entry`"
            )
        side = side[number.entry]
    if number.where:
        side = side.subs(number.where, simultaneous=True)
        # the substituted formulas may cancel
        factored = factor(side)
        side = factored if 2 * len(formula(factored)) < len(formula(side)) else side
    expression = number.scale * side**number.power
    value = expression.xreplace(_floats(scene)).evalf(PRECISION)
    if value.free_symbols or not value.is_real:
        names = ", ".join(sorted(symbol.name for symbol in value.free_symbols))
        reason = f"the scene {scene} has no value for {names}" if names else f"its value is {value}"
        raise InputError(f"{page.name}, {number.words!r}: expected a formula with a real value, but {reason}")
    return expression, value


@cache
def _floats(scene: str) -> dict[Expr, Expr]:
    """Return the values of the scene named ``scene`` by symbol, rounded to :data:`PRECISION` digits."""
    return {symbol: value.evalf(PRECISION) for symbol, value in scene_values(load_scene(scene)).items()}


def _step(page: Page, number: Number) -> Step:
    section = ""
    for item in page.items:
        if isinstance(item, Section):
            section = item.title
        steps = item.steps if isinstance(item, Table) else [item] if isinstance(item, Step) else []
        for step in steps:
            if step.claim.startswith(number.step) and number.section in ("", section):
                return step
    raise InputError(
        f"{page.name}, {number.words!r}: expected as `step` the first words of a claim on this page"
        f"{f' in the section {number.section!r}' if number.section else ''}, but no claim there begins with "
        f"{number.step!r}"
    )


def _of_scene(page: Page, lesson: Lesson) -> Iterator[Passage]:
    scene = load_scene(lesson.scene)
    values = _floats(lesson.scene)
    results = [(number, *value_of(page, number, lesson.scene)) for number in lesson.numbers]
    used = {symbol for _, expression, _ in results for symbol in expression.free_symbols}
    constants = {symbol: values[symbol] for symbol in UNIT if symbol in used and symbol in values}
    digits = _digits(constants, [(expression, value) for _, expression, value in results])
    listed = ", ".join(
        f"${formula(symbol)} = {_quantity(value, UNIT[symbol], digits)}$" for symbol, value in constants.items()
    )
    title = scene.title.replace(":", ",")
    yield Passage(f"The scene `{lesson.scene}` ({title}) has {listed}.")
    for number, expression, value in results:
        text = formula(expression)
        is_news = expression.free_symbols and _bare(text) != _bare(number.name)
        middle = f"{text} = " if is_news and len(text) <= LONGEST else ""
        yield Passage(number.words, ((number.name, f"{middle}{_quantity(value, number.unit)}"),))


def _bare(latex: str) -> str:
    """Return LaTeX without braces and blanks, so that two spellings of the same formula compare as equal."""
    return re.sub(r"[{} ]|\\,", "", latex)


def _digits(constants: dict[Expr, Expr], results: list[tuple[Expr, Expr]]) -> int:
    """Return how many digits, 4 to 16, the printed constants of a scene need to reproduce the results.

    ``results`` are formulas with their values. If a formula is a difference of nearly equal numbers, the constants
    need more digits than the result.
    """
    for digits in range(DIGITS, DOUBLE):
        rounded = {symbol: Float(_rounded(value, digits), PRECISION) for symbol, value in constants.items()}
        errors = (abs(expression.xreplace(rounded).evalf(PRECISION) - value) for expression, value in results)
        if all(error <= AGREEMENT * abs(value) + NOTHING for error, (_, value) in zip(errors, results, strict=True)):
            return digits
    return DOUBLE


def _rounded(value: Expr, digits: int) -> str:
    """Return a number as text with ``digits`` digits; a number below :data:`NOTHING` as "0"."""
    number = float(value)
    return "0" if abs(number) < NOTHING else f"{number:.{digits}g}"


def _quantity(value: Expr, unit: str, digits: int = DIGITS) -> str:
    r"""Return a number with its unit as LaTeX, such as ``2.5\,\mathrm{J}``, rounded to ``digits`` digits."""
    text = _rounded(value, digits)
    if "e" in text:
        mantissa, exponent = text.split("e")
        text = rf"{mantissa} \cdot 10^{{{int(exponent)}}}"
    return text + unit_latex("" if unit == "1" else unit)


@cache
def _exercise(name: str) -> Exercise:
    """Return the exercise of the template ``name`` with the seed 0."""
    return exercise(name)[0]


def _of_exercise(lesson: Lesson) -> Iterator[Passage]:
    """Yield the paragraphs of the exercise ``lesson.worked`` with its solution; every line of it is proven."""
    problem = _exercise(lesson.worked)
    quantities = ", ".join(f"${each.latex} = {each.value}{unit_latex(each.unit)}$" for each in problem.data)
    asked = " ".join(question.prompt for question in problem.questions if question.kind == "number")
    yield Passage(f"{problem.statement} Let {quantities}. {asked}" if quantities else f"{problem.statement} {asked}")
    for line in problem.solution:
        left, _, right = line.latex.partition(" = ")
        yield Passage(line.reason, ((left, right),))
