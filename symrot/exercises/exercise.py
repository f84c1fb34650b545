"""Exercises: a problem with numbers for its quantities, questions, three hints and a proven solution."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from random import Random
from typing import Any

from sympy import Expr, Rational, Symbol, pi, sstr

from symrot.exact.decide import decide
from symrot.exercises.problem import Asked, Line, Problem, Quantity
from symrot.exercises.sketches.table import sketch
from symrot.exercises.units import decimal, factor_of, unit_latex
from symrot.proof.derivation import ProofError
from symrot.proof.notation.printer import PagePrinter
from symrot.proof.notation.printer import formula as page_formula

__all__ = ["SCHEMA", "Datum", "Equation", "Exercise", "Question", "make", "related", "sheet_data"]

SCHEMA = 1
"""The version of the JSON data of exercises."""

DRAWS = 24
"""Number of random choices of numbers for an exercise, of which the one with the shortest answers is used.

There are more choices only if none of these suits the problem."""

MOST_DRAWS = 10_000
"""Number of random choices after which ProofError is raised, if none of them suits the problem."""

ZERO = 30
"""The length of an answer of zero, in digits, where numbers are chosen so that the answers are short.

An answer of zero teaches little. It counts as if it had this many digits, so such answers are rare.
"""

DIGITS = 17  # significant digits that distinguish any two doubles


@dataclass(frozen=True)
class Datum:
    """A given quantity of an exercise with its value, for instance the mass m = 2 kg.

    Attributes
    ----------
    symbol : str
        The symbol as students type it in an answer.
    latex : str
        The symbol as LaTeX.
    value : str
        The number as text, such as ``"0.4"`` or ``"2/3"``.
    unit : str
        The unit of the number; empty for a pure number.
    words : str
        The meaning of the symbol, such as ``"length"``.

    Examples
    --------
    >>> import symrot
    >>> symrot.exercise("inertia", count=1)[0].data[0].unit
    'kg'
    """

    symbol: str
    latex: str
    value: str
    unit: str
    words: str


@dataclass(frozen=True)
class Question:
    """One question of an exercise.

    Attributes
    ----------
    key : str
        The letter of the question, ``"a"``.
    kind : str
        ``"formula"`` or ``"number"``.
    prompt : str
        Markdown.
    name : str
        The symbol of the quantity that is asked for, LaTeX.
    answer : str
        The right formula, or the exact right number in ``unit``, as text.
    latex : str
        The answer as LaTeX.
    decimal : str
        The number, rounded to a double, as text; empty for a formula.
    unit : str
        The unit of the answer; empty for a pure number.
    symbols : dict of str to str
        The symbols of all given quantities, which a formula may use -> their units (``"1"`` for a pure number).
    positive : tuple of str
        Those of these symbols whose numbers are positive in every exercise of the template.
    slips : dict of str to str
        Mistake and symbol, such as ``"diameter R"`` -> the wrong number, in ``unit``, to which this mistake leads.

    Examples
    --------
    >>> import symrot
    >>> symrot.exercise("rod_about_end")[0].questions[0].answer
    'L**2*m/3'
    """

    key: str
    kind: str
    prompt: str
    name: str
    answer: str
    latex: str
    decimal: str
    unit: str
    symbols: dict[str, str]
    positive: tuple[str, ...]
    slips: dict[str, str]


@dataclass(frozen=True)
class Equation:
    """One line of a solution: the reason, and an equation in LaTeX that was proven when the exercise was made.

    Attributes
    ----------
    reason : str
        The reason why the equation holds, one sentence.
    latex : str
        The equation as LaTeX.

    Examples
    --------
    >>> import symrot
    >>> symrot.exercise("rod_about_end")[0].solution[0].reason
    'The parallel axis theorem, from the centre of mass to the axis.'
    """

    reason: str
    latex: str


@dataclass(frozen=True)
class Exercise:
    """One exercise with numbers: its statement, questions, hints and proven solution.

    Attributes
    ----------
    template, topic : str
        The name of the template from which the exercise was made, and its topic.
    seed : int
        The seed of the random numbers.
    title, statement : str
        Markdown.
    data : tuple of Datum
        The given quantities with their values.
    questions : tuple of Question
        The questions, in order.
    hints : tuple of 3 str
        The law; the first equation of the solution; the formula of the first answer with the numbers inserted.
    solution : tuple of Equation
        The lines of the solution, in order.
    figure : str
        A drawing of the arrangement with the letters of the exercise, SVG; empty if the template has none.

    Examples
    --------
    >>> import symrot
    >>> symrot.exercise("rod_about_end", seed=3)[0].title
    'A rod about its end'
    """

    template: str
    topic: str
    seed: int
    title: str
    statement: str
    data: tuple[Datum, ...]
    questions: tuple[Question, ...]
    hints: tuple[str, ...]
    solution: tuple[Equation, ...]
    figure: str = ""

    def to_json(self) -> dict[str, Any]:
        """Return the exercise as plain data for JSON; :meth:`from_json` restores an equal exercise."""
        return asdict(self)

    @staticmethod
    def from_json(data: Mapping[str, Any]) -> "Exercise":
        """Return the exercise that was converted to ``data`` by :meth:`to_json`.

        Raise KeyError, TypeError, AttributeError or ValueError if a field is missing or unknown, or if a question
        cannot be graded.
        """
        plain = dict(data)
        plain["data"] = tuple(Datum(**each) for each in data["data"])
        plain["questions"] = tuple(
            _checked(Question(**{**q, "positive": tuple(q["positive"])})) for q in data["questions"]
        )
        plain["hints"] = tuple(data["hints"])
        plain["solution"] = tuple(Equation(**each) for each in data["solution"])
        return Exercise(**plain)


def _checked(question: Question) -> Question:
    """Return a question that was made from JSON; raise an exception if it cannot be graded."""
    texts = [value for name, value in vars(question).items() if name not in ("symbols", "positive", "slips")]
    texts += question.positive
    texts += [text for pair in (*question.symbols.items(), *question.slips.items()) for text in pair]
    if not all(isinstance(text, str) for text in texts):
        raise ValueError(f"the question {question.key!r} has a field that is not a string")
    if question.kind not in ("formula", "number"):
        raise ValueError(f"the question {question.key!r} has the kind {question.kind!r}, not 'formula' or 'number'")
    if question.kind == "number":
        for number in (question.decimal, *question.slips.values()):
            float(number)
    return question


def sheet_data(exercises: Sequence[Exercise]) -> dict[str, Any]:
    """Return exercises as plain data for JSON, together with the version of the format (``schema``)."""
    return {"schema": SCHEMA, "exercises": [each.to_json() for each in exercises]}


def formula(side: Any) -> str:
    """Return the LaTeX of an expression or matrix, with ``arccos`` for the inverse cosine."""
    return re.sub(r"\\operatorname\{a(sin|cos|tan)\}", r"\\arc\1", page_formula(side))


class _WithNumbers(PagePrinter):
    """A LaTeX printer that prints the value and unit of each quantity instead of its symbol."""

    def __init__(self, data: Mapping[Symbol, str]) -> None:
        super().__init__({"mat_delim": "[", "mat_str": "matrix", "fold_short_frac": False, "inv_trig_style": "full"})
        self.data = data

    def _print_Symbol(self, symbol: Symbol, style: str = "plain") -> str:
        return self.data.get(symbol) or super()._print_Symbol(symbol, style)


def make(template: str, topic: str, seed: int, problem: Problem, source: Random) -> Exercise:
    """Return an exercise made from a problem: prove its solution, choose random numbers, compute the answers.

    ``template``, ``topic`` and ``seed`` are recorded in the exercise; ``source`` is the generator of the random
    numbers.

    Raises
    ------
    ProofError
        If a line of the solution does not hold, or no random numbers suit the problem.
    """
    for line in problem.lines:
        _prove(template, line)
    drawn = _draw(problem, source)
    values = {quantity.symbol: _si(quantity, number) for quantity, number in drawn}
    return Exercise(
        template, topic, seed, problem.title, problem.statement,
        tuple(Datum(sstr(q.symbol), formula(q.symbol), number, q.unit, q.words) for q, number in drawn),
        tuple(_questions(problem, values)), _hints(problem, drawn), tuple(_solution(template, problem, drawn, values)),
        sketch(template, *problem.sketch),
    )  # fmt: skip


def _prove(template: str, line: Line) -> None:
    decision = decide(line.left, line.right, line.relations)
    if decision.verdict != "true":
        raise ProofError(f"{template}, {line.claim!r} does not hold: left - right = {decision.residual}")


def _si(quantity: Quantity, number: str) -> Expr:
    return Rational(number) * factor_of(quantity.unit)


def _draw(problem: Problem, source: Random) -> list[tuple[Quantity, str]]:
    """Choose random numbers for the quantities so that the answers are short; return pairs (quantity, number)."""
    best: tuple[int, list[tuple[Quantity, str]]] | None = None
    for n in range(MOST_DRAWS):
        if n >= DRAWS and best is not None:
            break
        drawn = [(quantity, source.choice(quantity.numbers)) for quantity in problem.quantities]
        values = {quantity.symbol: _si(quantity, number) for quantity, number in drawn}
        if not problem.fits(values):
            # such as lengths that contradict each other
            continue
        answers = [_exact(asked, values) for asked in problem.asked]
        if any(answer.is_finite is False or answer.is_real is False for answer in answers):
            continue
        repeated = len(drawn) - len({(number, quantity.unit) for quantity, number in drawn})
        length = sum(_length(answer) for answer in answers) + repeated
        if best is None or length < best[0]:
            best = length, drawn
    if best is None:
        raise ProofError(
            f"{problem.title}: expected numbers that suit the problem, got none in {MOST_DRAWS} random choices"
        )
    return best[1]


def _length(answer: Expr) -> int:
    """Return a measure of the length of an answer: about its number of digits, and more for zero, 1/3 or sqrt(2)."""
    if answer.is_zero:
        return ZERO
    if not answer.is_Rational:
        return 6 + int(answer.count_ops())
    rest, power = answer.q, 0
    for prime in (2, 5):
        while rest % prime == 0:
            rest //= prime
            power += 1
    return 8 + len(str(rest)) if rest > 1 else len(str(abs(answer.p)).rstrip("0")) + power // 2


def _questions(problem: Problem, values: Mapping[Symbol, Expr]) -> Iterator[Question]:
    keys = iter("abcdefghijklmnopqrstuvwxyz")
    units = {sstr(q.symbol): q.unit or "1" for q in problem.quantities}
    positive = tuple(sstr(q.symbol) for q in problem.quantities if all(Rational(number) > 0 for number in q.numbers))
    for asked in problem.asked:
        if asked.as_formula:
            names = ", ".join(f"${formula(symbol)}$" for symbol in _used(problem, asked))
            yield Question(
                next(keys), "formula", f"Find ${asked.name}$, {asked.words}, as a formula in {names}.", asked.name,
                sstr(asked.formula), formula(asked.formula), "", asked.unit, units, positive, {},
            )  # fmt: skip
        if asked.as_number:
            exact = _exact(asked, values)
            prompt = f"Compute ${asked.name}$, {asked.words}{_in_unit(asked.unit)}."
            yield Question(
                next(keys), "number", prompt, asked.name, sstr(exact), _number_latex(exact, asked.unit),
                decimal(exact, DIGITS), asked.unit, units, positive, dict(_slips(problem, asked, values, exact)),
            )  # fmt: skip


def _in_unit(unit: str) -> str:
    named = {"": "", "deg": ", in degrees"}
    space = r"\,"
    return named.get(unit, f", in ${unit_latex(unit).removeprefix(space)}$")


def _used(problem: Problem, asked: Asked) -> list[Symbol]:
    """Return the symbols of given quantities that occur in the formula of a question, in the order of the problem."""
    return [q.symbol for q in problem.quantities if asked.formula.has(q.symbol)]


def _exact(asked: Asked, values: Mapping[Symbol, Expr]) -> Expr:
    """Return the exact answer to a question, in the unit of the question; ``values`` are the quantities in SI units."""
    return asked.formula.xreplace(dict(values)) / factor_of(asked.unit)


def _slips(problem: Problem, asked: Asked, values: Mapping[Symbol, Expr], exact: Expr) -> Iterator[tuple[str, str]]:
    """Yield the wrong answers to which usual slips lead, as pairs (slip, number).

    ``("diameter R", "0.5")`` is the answer 0.5 if the diameter is used as the radius R.
    """
    for quantity in problem.quantities:
        symbol = quantity.symbol
        if not asked.formula.has(symbol):
            continue
        # other slips: a radius used as a diameter, degrees used as radians, a unit that is not converted
        for code, value in _misused(quantity, values[symbol]):
            number = _exact(asked, {**values, symbol: value})
            if number.is_finite and number.is_real and number != exact:
                yield f"{code} {sstr(symbol)}", decimal(number, DIGITS)


def _misused(quantity: Quantity, value: Expr) -> Iterator[tuple[str, Expr]]:
    if "radius" in quantity.words:
        yield "diameter", 2 * value
    if "diameter" in quantity.words:
        yield "radius", value / 2
    if quantity.unit == "deg":
        yield "degrees", 180 * value / pi
    elif factor_of(quantity.unit) != 1:
        yield "unconverted", value / factor_of(quantity.unit)


def _number_latex(exact: Expr, unit: str) -> str:
    r"""Return an answer with its unit as LaTeX: ``0.125`` for 1/8, ``\frac{1}{3} \approx 0.3333`` for 1/3.

    A number of 40 or more letters of LaTeX is printed only rounded, after ``\approx``.
    """
    rounded = decimal(exact)
    latex = _scientific(rounded)
    if not exact.is_Rational or Rational(rounded) != exact:
        text = formula(exact)
        latex = rf"{text} \approx {latex}" if len(text) < 40 else rf"\approx {latex}"
    return latex + unit_latex(unit)


def related(number: str) -> str:
    r"""Return a LaTeX number preceded by ``=``, unless it already begins with ``\approx`` because it is rounded."""
    return number if number.startswith(r"\approx") else f"= {number}"


def _scientific(text: str) -> str:
    mantissa, _, exponent = text.partition("e")
    return rf"{mantissa} \cdot 10^{{{exponent}}}" if exponent else mantissa


def _hints(problem: Problem, drawn: Sequence[tuple[Quantity, str]]) -> tuple[str, str, str]:
    first = problem.lines[0]
    asked = problem.asked[0]
    return (
        problem.law,
        f"{first.claim} $${_equation(first)}$$",
        f"With the numbers: $${asked.name} = {_substituted(asked, drawn)}$$",
    )


def _equation(line: Line) -> str:
    return f"{line.named or formula(line.left)} = {formula(line.right)}"


def _substituted(asked: Asked, drawn: Sequence[tuple[Quantity, str]]) -> str:
    """Return the formula of a question as LaTeX, with values and units instead of symbols, for the third hint.

    ``drawn`` are pairs (quantity, number).
    """
    data = {q.symbol: rf"\left({_scientific(number)}{unit_latex(q.unit)}\right)" for q, number in drawn}
    return str(_WithNumbers(data).doprint(asked.formula))


def _solution(
    template: str, problem: Problem, drawn: Sequence[tuple[Quantity, str]], values: Mapping[Symbol, Expr]
) -> Iterator[Equation]:
    for line in problem.lines:
        yield Equation(line.claim, _equation(line))
    for asked in problem.asked:
        if not any(line.named == asked.name and line.right == asked.formula for line in problem.lines):
            raise ProofError(f"{template}: no line of the solution proves {asked.name} = {asked.formula}")
        if asked.as_number:
            exact = _exact(asked, values)
            _prove(template, Line("the number", asked.formula.xreplace(dict(values)), exact * factor_of(asked.unit)))
            numbers = _substituted(asked, drawn)
            yield Equation(
                "With the numbers.", rf"{asked.name} = {numbers} {related(_number_latex(exact, asked.unit))}"
            )
