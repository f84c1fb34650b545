"""The grading of numerical answers with units."""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite, log10, pi, sqrt

from symrot.checker.units.conversion import ANGULAR, UnitProduct
from symrot.checker.units.units import unit_text
from symrot.errors import InputError
from symrot.exercises.exercise import Question
from symrot.exercises.grading.left_side import is_multiple
from symrot.exercises.grading.mark import Mark
from symrot.exercises.grading.words import NUMBER_FAULTS, RIGHT, SLIPS
from symrot.exercises.units import unit_of
from symrot.formula.tree import evaluate, parse

__all__ = ["TOLERANCE", "mark_number"]

TOLERANCE = 0.005
"""The largest relative error of a right number; 0.005 is half a unit of the third significant digit of 100."""

FEWEST_DIGITS = 2  # significant digits from which a correctly rounded number is right, whatever its relative error
SMALL = 1e-12  # difference below which two numbers count as equal
LONGEST_UNIT = 60  # largest number of characters of a unit that is read

_LATEX = (
    (r"\\d?t?frac\{([^{}]*)\}\{([^{}]*)\}", r"(\1)/(\2)"), (r"\\sqrt\{([^{}]*)\}", r"sqrt(\1)"),
    (r"\\d?t?frac\{([^{}]*)\}\{([^{}]*)\}", r"(\1)/(\2)"),
    (r"\\(?:SI|qty)\{([^{}]*)\}\{([^{}]*)\}", r"\1 \2"), (r"\\(?:mathrm|text|operatorname|rm)\s*\{([^{}]*)\}", r" \1 "),
    (r"\^\{?\\circ\}?|\\degree|°", " deg"), (r"\\(?:cdot|times)\b|[·⋅×]", "*"), (r"\\approx\b|≈", "="),
    (r"\\[,;: !]|~|\\quad|\\left|\\right|\$", " "), (r"\\pi\b|π", " pi "), (r"[{]", "("), (r"[}]", ")"), ("−", "-"),
    (r"√\(", "sqrt("), (r"√(\d+(?:\.\d+)?)", r"sqrt(\1)"),
)  # fmt: skip
"""Pairs (regular expression, replacement), applied in turn, that turn LaTeX, and signs such as ² and π, into ASCII."""

_RAISED = re.compile("[⁺⁻]?[⁰¹²³⁴-⁹]+")
_PLAIN_DIGITS = str.maketrans("⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "+-0123456789")
_COMPARISON = re.compile(r"[<>≠≤≥]|!=|\\(?:neq?|leq?|geq?)\b")
_EXPONENT = re.compile(r"(\d)\s*[*x]\s*10\s*(?:\^|\*\*)\s*\(?([+-]?\d+)\)?")
_HERTZ = re.compile(r"(?<![A-Za-z])(k|M|)Hz\b")
_ROTATIONS = {"": "rev/s", "k": "rev/ms", "M": "rev/us"}
_PLAIN = re.compile(r"[-+]?\s*(\d*\.?\d*)(?:[eE][-+]?\d+)?")
_FUNCTIONS: dict[str, Callable[..., float]] = {"sqrt": sqrt, "abs": abs}


@dataclass(frozen=True)
class _Number:
    """A number typed by a student: its value in its unit, its unit (None if missing), and its significant digits.

    The digits are None for a number that counts as exact, such as 1/3.
    """

    value: float
    unit: UnitProduct | None
    digits: int | None

    @property
    def half_digit(self) -> float:
        """Half a unit of the last written digit: the largest error of a correctly rounded number."""
        if self.digits is None or self.value == 0:
            return 0.0
        return 0.5 * 10.0 ** (int(log10(abs(self.value)) // 1) - self.digits + 1)


def mark_number(key: str, answer: str, question: Question) -> Mark:
    """Grade an answer that is a number, and return its mark.

    Parameters
    ----------
    key : str
        The name of the question, which is copied to the mark.
    answer : str
        A number with a unit: ``"0.125 kg m^2"``, ``"3/8"``, ``"45 deg"``, ``"1.2e-3 m"``, or LaTeX.
    question : Question
        Of kind ``"number"``.
    """
    # next to an angle, a hertz is one rotation per second, as the checker reads it
    turns = not ANGULAR.isdisjoint(re.findall(r"[a-z]+", question.unit))
    text = _HERTZ.sub(lambda match: _ROTATIONS[match[1]], answer) if turns else answer
    numbers = [*_readings(text, question)]
    if not numbers:
        example = f"0.125 {question.unit}".strip()
        sentence = f"expected a number with a unit such as '{example}', got {answer[:60]!r}"
        return Mark(key, answer, "unread", text=sentence)
    marks = [_mark(key, answer, number, question) for number in numbers]
    return max(marks, key=lambda mark: mark.credit)


def _readings(answer: str, question: Question) -> Iterator[_Number]:
    """Yield the possible readings of a typed number: ``1,234`` may be 1.234 or 1234.

    There are none for an inequality such as ``5 >= 4``, and for an equation such as ``2 I = 4 kg m^2``, which does not
    state the asked quantity itself.
    """
    left = answer[: sign.start()].strip() if (sign := re.search(r"=|≈|\\approx\b", answer)) else ""
    if _COMPARISON.search(answer) or is_multiple(left, question.name, question.symbols):
        return
    text = _RAISED.sub(lambda match: f"^{match[0].translate(_PLAIN_DIGITS)}", answer.strip())
    for pattern, instead in _LATEX:
        text = re.sub(pattern, instead, text)
    text = re.split(r"=", text)[-1].strip().rstrip(".,;")
    text = re.sub(r"\s+\^", "^", text)
    text = _EXPONENT.sub(r"\1e\2", text)
    text = re.sub(r"(?<=[\d)])\s*(?=(?:pi\b|sqrt\b))", "*", text)
    texts = {re.sub(r"(?<=\d),(?=\d)", ".", text): None}
    if re.search(r"(?<=\d),\d{3}(?!\d)", text):
        texts[re.sub(r"(?<=\d),(?=\d{3}(?!\d))", "", text)] = None
    for each in texts:
        number = _read(each)
        if number is not None:
            yield number


def _read(text: str) -> _Number | None:
    """Return the number and unit in a text such as ``0.5 kg m^2``, whose unit may be missing.

    Return None if the text is not a number, with or without a unit.
    """
    for end in range(len(text), max(0, len(text) - LONGEST_UNIT), -1):
        rest = text[end:].strip().removeprefix("*")
        if end < len(text) and (text[end - 1].isalnum() and text[end].isalnum() and not text[end - 1].isdigit()):
            continue
        inside = re.fullmatch(r"\(([^()]*)\)|\[([^\[\]]*)\]", rest)
        unit = unit_of((inside[1] or inside[2] or "") if inside else rest) if rest else None
        if rest and unit is None:
            continue
        value = _value(text[:end])
        if value is not None:
            return _Number(value, unit, _digits(text[:end].strip()))
    return None


def _value(text: str) -> float | None:
    plain = text.replace("^", "**").strip()
    if not plain or not re.search(r"\d|pi", plain):
        return None
    try:
        value = float(evaluate(parse(plain), {"pi": pi}, _FUNCTIONS, float))
    except (InputError, KeyError, ArithmeticError, ValueError, TypeError):
        return None
    return value if isfinite(value) else None


def _digits(text: str) -> int | None:
    """Return the number of significant digits of a decimal: 3 for ``0.0120``.

    None for a fraction or a root, because such a number is exact.
    """
    plain = _PLAIN.fullmatch(text)
    if plain is None:
        return None
    return len(plain[1].replace(".", "").lstrip("0")) or 1


def _mark(key: str, answer: str, number: _Number, question: Question) -> Mark:
    """Return the mark for one reading of a typed number, such as 1,234 read as 1.234 or as 1234.

    ``key`` and ``answer`` are copied to the mark; ``question`` has the right number.
    """
    truth = float(question.decimal)
    own = unit_of(question.unit) if question.unit else None
    if number.unit is not None and number.unit.dimension != (own.dimension if own else {}):
        texts = {"own": unit_text(number.unit.dimension), "unit": question.unit or "1"}
        return _wrong(key, answer, "dimension", texts)
    scale = _factor(number.unit) / _factor(own) if number.unit is not None else 1.0
    value = number.value * scale
    if not isfinite(value):
        return _wrong(key, answer, "other", {})
    if _is_right(value, truth, number.half_digit * scale, number.digits):
        forgotten = number.unit is None and own is not None and bool(own.dimension)
        if forgotten:
            return _wrong(key, answer, "unit_forgotten", {"unit": question.unit})
        return Mark(key, answer, "right", RIGHT)
    for code, texts in _faults(value, truth, question):
        return _wrong(key, answer, code, texts)
    if _rounds(value, truth, number.half_digit * scale):
        return _wrong(key, answer, "coarse", {})
    return _wrong(key, answer, "other", {})


def _factor(unit: UnitProduct | None) -> float:
    return float(unit.fraction) * pi**unit.power_of_pi if unit else 1.0


def _near(value: float, truth: float) -> bool:
    return abs(value - truth) <= TOLERANCE * (1 + 1e-9) * abs(truth) or abs(value - truth) < SMALL


def _rounds(value: float, truth: float, half_digit: float) -> bool:
    return abs(value - truth) <= half_digit * (1 + 1e-9)


def _is_right(value: float, truth: float, half_digit: float, digits: int | None) -> bool:
    if _near(value, truth):
        return True
    return digits is not None and digits >= FEWEST_DIGITS and _rounds(value, truth, half_digit)


def _faults(value: float, truth: float, question: Question) -> Iterator[tuple[str, dict[str, str]]]:
    """Yield each usual error that explains a wrong number, likeliest first, as a pair (code, words for the message).

    The code is a key of :data:`symrot.exercises.grading.words.NUMBER_FAULTS`. ``value`` is the student's number and
    ``truth`` the right one, both in the unit of the question.
    """
    if _near(-value, truth):
        yield "sign", {}
    for slip, number in question.slips.items():
        code, _, name = slip.partition(" ")
        if _near(value, float(number)):
            yield "slip", {"slip": SLIPS[code].format(name)}
    for factor in (Fraction(2), Fraction(1, 2)):
        if _near(value, float(factor) * truth):
            yield "factor", {"factor": str(factor)}
    if _near(value, truth * 180 / pi) or _near(value, truth * pi / 180):
        yield "degrees", {}
    if _near(value, truth * 2 * pi) or _near(value, truth / (2 * pi)):
        yield "turns", {}
    power = log10(abs(value)) - log10(abs(truth)) if value * truth > 0 else 0.0
    if round(power) and abs(power - round(power)) < TOLERANCE / 2:
        yield "power_of_ten", {}
    if truth and _near(value, 1 / truth):
        yield "inverse", {}
    for factor in (Fraction(4), Fraction(1, 4), Fraction(3), Fraction(1, 3)):
        if _near(value, float(factor) * truth):
            yield "factor", {"factor": str(factor)}


def _wrong(key: str, answer: str, code: str, texts: dict[str, str]) -> Mark:
    credit, sentence = NUMBER_FAULTS[code]
    return Mark(key, answer, "wrong", credit, code, sentence.format(**texts))
