"""A campaign against grading: right answers in other forms, and answers with one realistic error.

``python -m tests.campaigns.exercises.grading --right 1000 --wrong 1000 --seed 2026`` takes the questions of all templates
in turn. It rewrites right answers by SymPy and by hand (order, expanded, factored, LaTeX, Greek letters, other units,
rounding), and puts one error into others. That an answer with an error is wrong is judged by numbers at random points,
without the checker. It exits with 1 if a right answer is graded wrong or a wrong answer right.
"""

import sys
from argparse import ArgumentParser
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from math import pi
from random import Random
from typing import Any

from sympy import (
    Add,
    Expr,
    Mul,
    Pow,
    Symbol,
    cos,
    expand,
    factor,
    lambdify,
    nan,
    powsimp,
    sin,
    sstr,
    tan,
    together,
    zoo,
)
from sympy.parsing.sympy_parser import parse_expr

import symrot
from symrot.checker.units.units import read_unit
from symrot.exercises.exercise import Question
from symrot.exercises.grading.formulas import GREEK
from symrot.exercises.grading.grade import KINDS
from symrot.exercises.grading.mark import Mark
from symrot.exercises.templates import TOPICS
from symrot.exercises.units import unit_of
from symrot.proof.notation.printer import formula

POINTS = 3
SAME_UNITS = ("mm", "cm", "m", "km", "g", "kg", "s", "ms", "min", "deg", "rad", "rpm", "rad/s", "N", "kN", "J", "kJ", "W", "kW",
              "kg m^2", "kg cm^2", "g m^2", "N m", "N mm", "m/s", "mm/s", "m/s^2", "kg m^2/s", "1/s", "N m s")  # fmt: skip


@dataclass(frozen=True)
class Case:
    """One answer: the question, the text, and the kinds of error that name what is wrong (none for a right answer)."""

    name: str
    question: Question
    answer: str
    kinds: tuple[str, ...] = ()


def _expression(question: Question) -> Expr:
    names = {name: Symbol(name, real=True, positive=name in question.positive or None) for name in question.symbols}
    return parse_expr(question.answer, local_dict=names, evaluate=True)


def _shuffled(value: Expr, source: Random) -> str:
    """Return a formula as text with terms and factors in a random order."""
    if isinstance(value, (Add, Mul)):
        args = list(value.args)
        source.shuffle(args)
        return (" + " if value.is_Add else "*").join(f"({_shuffled(arg, source)})" for arg in args)
    if isinstance(value, Pow) and value.exp.is_Integer:
        return f"({_shuffled(value.base, source)})**({value.exp})"
    return sstr(value)


def _greek(text: str) -> str:
    for letter, name in GREEK.items():
        text = text.replace(f"{name}_", f"{letter}_").replace(f"({name})", f"({letter})")
    return text


REWRITINGS: dict[str, Callable[[Expr, str, Random], str]] = {
    "shuffled": lambda value, text, source: _shuffled(value, source),
    "expanded": lambda value, text, source: sstr(expand(value)),
    "factored": lambda value, text, source: sstr(factor(value)),
    "together": lambda value, text, source: sstr(together(value)).replace("**", "^"),
    "caret": lambda value, text, source: text.replace("**", "^"),
    "spaces": lambda value, text, source: text.replace("**", "^").replace("*", " "),
    "latex": lambda value, text, source: formula(powsimp(value)),
    "latex_expanded": lambda value, text, source: formula(expand(value)),
    "greek": lambda value, text, source: _greek(text),
    "doubled": lambda value, text, source: f"2*({text}) - ({sstr(expand(value))})",
    "half_twice": lambda value, text, source: f"({_shuffled(value, source)})/2*2",
}


def right_cases(source: Random) -> Iterator[Case]:
    """Yield right answers in other forms."""
    for name, question in questions(source):
        if question.kind == "formula":
            text = source.choice([*REWRITINGS.values()])(_expression(question), question.answer, source)
            yield Case(name, question, source.choice(("", f"{question.name} = ")) + text if "\\" in text else text)
        else:
            yield Case(name, question, _number(question, source))


def _number(question: Question, source: Random) -> str:
    """Return the number rounded and written in some way, in some unit of its dimension."""
    value, unit = float(question.decimal), question.unit
    own = unit_of(unit) if unit else None
    if own is not None and source.random() < 0.5:
        same = [
            each
            for each in SAME_UNITS
            if read_unit(each) == own.dimension and (own.dimension or unit in ("deg", "rad"))
        ]
        unit = source.choice([*same, unit])
        other = unit_of(unit)
        value *= float(own.fraction) * pi**own.power_of_pi / (float(other.fraction) * pi**other.power_of_pi)
    digits = source.choice((3, 4, 5, 6))
    forms = (
        f"{value:.{digits}g}", f"{value:.{digits - 1}e}", f"{value:.{digits}g}".replace(".", ","),
        f"{value:.{digits - 1}e}".replace("e", "*10^"),
    )  # fmt: skip
    text = source.choice(forms)
    shown = source.choice((unit, unit.replace("^2", "²"), unit.replace(" ", "*")))
    return source.choice((f"{text} {shown}", f"x = {text} {shown}", f"{text}\\,\\mathrm{{{unit}}}"))


def wrong_cases(source: Random) -> Iterator[Case]:
    """Yield answers with one error."""
    for name, question in questions(source):
        case = (
            _faulty_formula(name, question, source)
            if question.kind == "formula"
            else _faulty_number(name, question, source)
        )
        if case is not None:
            yield case


def _faults(value: Expr, source: Random) -> dict[str, Callable[[], Expr]]:
    """Return errors by kind, each as a function that puts it somewhere into a formula."""
    pieces = [*_pieces(value)]
    sums = [piece for piece in pieces if piece.is_Add]
    calls = [piece for piece in pieces if isinstance(piece, (sin, cos, tan))]
    powers = [piece for piece in pieces if piece.is_Pow and piece.exp == 2]
    symbols = sorted(value.free_symbols, key=str)
    exchanged = {sin: cos, cos: sin, tan: sin}
    faults: dict[str, Callable[[], Expr]] = {
        "overall_sign": lambda: -value,
        "factor": lambda: value * source.choice((2, 1 / Pow(2, 1), 3)),
        "inverse": lambda: 1 / value,
    }
    if sums:
        piece = source.choice(sums)
        term = source.choice(piece.args)
        faults["sign_of_term"] = lambda: value.xreplace({piece: piece - 2 * term})
        faults["missing_term"] = lambda: value.xreplace({piece: piece - term})
    if calls:
        call = source.choice(calls)
        faults["sin_cos_swap"] = lambda: value.xreplace({call: exchanged[type(call)](*call.args)})
        faults["half_angle"] = lambda: value.xreplace({call: type(call)(2 * call.args[0])})
        faults["double_half_angle"] = lambda: value.xreplace({call: type(call)(call.args[0] / 2)})
    if powers:
        power = source.choice(powers)
        faults["exponent"] = lambda: value.xreplace({power: power.base})
    if len(symbols) > 1:
        pair = source.sample(symbols, 2)
        faults["exchanged"] = lambda: value.xreplace({pair[0]: pair[1], pair[1]: pair[0]})
        faults["wrong_symbol"] = lambda: value.xreplace({pair[0]: pair[1]})
    return faults


NAMED = {
    "overall_sign": ("overall_sign", "sign_of_term"), "sign_of_term": ("sign_of_term", "overall_sign", "wrong_symbol", "exchanged"),
    "factor": ("factor",), "inverse": ("inverse",), "missing_term": ("missing_term", "factor", "extra_term"),
    "sin_cos_swap": ("sin_cos_swap",), "half_angle": ("half_angle", "double_half_angle", "factor"),
    "double_half_angle": ("double_half_angle", "half_angle", "factor"), "exponent": ("exponent", "factor"),
    "exchanged": ("exchanged", "wrong_symbol", "sign_of_term", "overall_sign", "inverse"),
    "wrong_symbol": ("wrong_symbol", "exponent", "factor", "missing_term", "exchanged"),
}  # fmt: skip
"""Error -> the diagnoses that name it: some errors are the same formula, such as a term of -x with the wrong sign."""


def _pieces(value: Expr) -> Iterator[Expr]:
    yield value
    for arg in value.args:
        yield from _pieces(arg)


def _faulty_formula(name: str, question: Question, source: Random) -> Case | None:
    value = _expression(question)
    faults = _faults(value, source)
    kind = source.choice(sorted(faults))
    wrong = faults[kind]()
    # exchanged symbols can make a denominator zero, which nobody answers
    if wrong.has(zoo, nan) or not wrong.free_symbols <= value.free_symbols or not _differ(value, wrong, source):
        return None
    return Case(name, question, sstr(wrong), NAMED[kind])


def _differ(value: Expr, wrong: Expr, source: Random) -> bool:
    """Return whether two formulas differ at random points."""
    symbols = sorted(value.free_symbols | wrong.free_symbols, key=str)
    first, second = (lambdify(symbols, each, [{"Abs": abs}, "cmath"]) for each in (value, wrong))
    for _ in range(POINTS):
        point = [source.uniform(0.3, 1.4) for _ in symbols]
        try:
            left, right = first(*point), second(*point)
        except (ZeroDivisionError, ValueError):
            continue
        if abs(left - right) > 1e-6 * (abs(left) + abs(right)):
            return True
    return False


def _faulty_number(name: str, question: Question, source: Random) -> Case | None:
    value, unit = float(question.decimal), question.unit
    own = unit_of(unit) if unit else None
    faults: dict[str, tuple[str, tuple[str, ...]]] = {
        "sign": (f"{-value:.4g} {unit}", ("sign", "slip")),
        "factor": (f"{value * source.choice((2, 0.5)):.4g} {unit}", ("factor", "slip")),
        "power_of_ten": (f"{value * 10.0 ** source.choice((-3, 3, 2, -1)):.4g} {unit}", ("power_of_ten", "slip")),
        "inverse": (f"{1 / value if value else 1:.4g} {unit}", ("inverse", "factor", "slip", "power_of_ten")),
    }
    for slip, number in question.slips.items():
        faults[slip] = (f"{float(number):.4g} {unit}", ("slip", "sign", "factor", "power_of_ten"))
    if own is not None and own.dimension:
        faults["unit_forgotten"] = (f"{value:.4g}", ("unit_forgotten",))
        faults["dimension"] = (f"{value:.4g} {source.choice(('m', 'kg', 's', 'N'))}", ("dimension",))
    if unit == "deg":
        faults["degrees"] = (f"{value * pi / 180:.4g} deg", ("degrees",))
    kind = source.choice(sorted(faults))
    text, kinds = faults[kind]
    wrong = float(text.split()[0])
    close = abs(wrong - value) <= 0.006 * abs(value)
    same_unit = kind == "dimension" and read_unit(text.split()[1]) == own.dimension
    if same_unit or (close and kind not in ("unit_forgotten", "dimension")):
        return None
    return Case(name, question, text.strip(), kinds)


def questions(source: Random) -> Iterator[tuple[str, Question]]:
    """Yield the questions of all templates in turn, with other numbers in each round."""
    seed = source.randrange(1000)
    while True:
        for name in chain(*TOPICS.values()):
            yield from ((name, question) for question in symrot.exercise(name, seed=seed)[0].questions)
        seed += 1


def mark(case: Case) -> Mark:
    """Return the mark of an answer."""
    return KINDS[case.question.kind](case.question.key, case.answer, case.question)


def first(cases: Iterator[Case], count: int) -> list[Case]:
    """Return the first cases."""
    return [case for case, _ in zip(cases, range(count), strict=False)]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the campaign and print its figures."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument("--right", type=int, default=1000)
    parser.add_argument("--wrong", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=2026)
    options = parser.parse_args(arguments)
    outcomes: Counter[str] = Counter()
    failures: list[Any] = []
    for case in first(right_cases(Random(f"right {options.seed}")), options.right):
        result = mark(case)
        outcomes[f"right answers graded {result.outcome}"] += 1
        if result.outcome != "right":
            failures.append((case.name, case.question.answer, result))
    for case in first(wrong_cases(Random(f"wrong {options.seed}")), options.wrong):
        result = mark(case)
        outcomes[f"wrong answers graded {result.outcome}"] += 1
        outcomes["kind of error named"] += result.code in case.kinds
        if result.outcome == "right" or result.code not in case.kinds:
            failures.append((case.name, case.question.answer, result, case.kinds))
    for failure in failures:
        print(*failure)
    for words, count in sorted(outcomes.items()):
        print(f"{words}: {count}")
    return 1 if outcomes["right answers graded wrong"] or outcomes["wrong answers graded right"] else 0


if __name__ == "__main__":
    sys.exit(main())
