"""Parts of a page that all formats share: equations, the remarks below them, units, and the footer."""

import re
from collections.abc import Iterable, Iterator
from typing import Any

from sympy import Add, Expr

from symrot.proof.notation.printer import formula
from symrot.proof.page import Page, Passage, Step, Table
from symrot.symbols import UNIT

__all__ = ["equation", "footer", "passage_equations", "remarks", "repetitions", "table_rows", "units"]

MANY = 6
"""Smallest number of steps with equal claim and reason for which a page prints the reason only once."""


def equation(step: Step) -> str:
    left = step.named or formula(step.left)
    right = formula(step.right if step.display is None else step.display)
    return f"{left} = {right} > 0" if step.relation == ">" else f"{left} = {right}"


def repetitions(page: Page) -> frozenset[int]:
    """Return the numbers of the steps that repeat the claim and the reason of an earlier step.

    Only claims and reasons that at least MANY steps share are looked for. Claims count as equal if they differ only in
    formulas and sequences of axes such as ZXZ; reasons must be the same.
    """
    places: dict[tuple[str, str], list[int]] = {}
    for number, step in enumerate(page.steps, page.first):
        # a page may prove one result for many sequences of angles, or many solids
        claim = re.sub(r"\$[^$]*\$|\b[XYZ]{3}\b", "", step.claim)
        places.setdefault((claim, step.reason), []).append(number)
    # the page does not print the reason of these steps
    return frozenset(number for numbers in places.values() if len(numbers) >= MANY for number in numbers[1:])


def remarks(step: Step, is_repetition: bool = False) -> Iterator[str]:
    """Yield the remarks on a step, each a sentence: its reason, hypotheses, conditions and source.

    A repetition leaves out the reason.
    """
    if not is_repetition:
        yield f"*Why:* {step.reason}."
    if step.hypotheses:
        yield f"*Given:* {_list(map(_hypothesis, step.hypotheses))}."
    if step.conditions:
        yield f"*Where:* {_list(map(formula, step.conditions))}."
    if step.source:
        yield f"*Printed in:* {step.source}."


def _hypothesis(zero: Expr) -> str:
    """Return an expression that is zero as the LaTeX of an equation: ``a - b`` gives ``a = b``."""
    terms = zero.expand().as_ordered_terms()
    # terms with a minus sign
    right = [-term for term in terms if term.could_extract_minus_sign()]
    left = [term for term in terms if not term.could_extract_minus_sign()]
    return f"{formula(Add(*left))} = {formula(Add(*right))}"


def _list(formulas: Iterable[str]) -> str:
    return ", ".join(f"${text}$" for text in formulas)


def units(page: Page) -> str:
    """Return the units of the symbols in the steps and equations of a page as one text; empty if none are known."""
    sides: list[Any] = [side for step in page.steps for side in (step.left, step.right)]
    passages = (item for item in page.items if isinstance(item, Passage))
    sides += [side for passage in passages for pair in passage.equations for side in pair]
    used = {symbol for side in sides for symbol in getattr(side, "free_symbols", ())}
    groups: dict[str, list[str]] = {}
    for symbol, unit in UNIT.items():
        if symbol in used:
            groups.setdefault(unit, []).append(f"${formula(symbol)}$")
    phrases = ((", ".join(names), "without unit" if unit == "1" else f"in {unit}") for unit, names in groups.items())
    return "; ".join(f"{names} {unit}" for names, unit in phrases)


def table_rows(table: Table, number: int) -> Iterator[tuple[str, ...]]:
    """Yield the titles of a table's columns and then its rows, each a tuple of cells in Markdown.

    If steps prove the rows, each row begins with the numbers of its steps; ``number`` is the number of the page's last
    step before the table.
    """
    yield ("Steps", *table.head) if table.is_proven else table.head
    for cells, steps in table.rows:
        first, last = number + 1, number + len(steps)
        number = last
        numbers = f"{first}" if first == last else f"{first}–{last}"
        yield (numbers, *cells) if table.is_proven else cells


def footer(page: Page) -> str:
    count = len(page.steps)
    proven = f"{count} steps, each proven" if count != 1 else "One step, proven"
    sides = [side for step in page.steps for side in step.printed]
    rest = "" if all(sides) else "; the others are names or words for the expressions that were proven"
    sentence = (
        "Sides of equations that are printed from the proof, or were parsed and proven equal to the expression in the "
        f"proof: {sum(sides)} of {len(sides)}{rest}."
    )
    return (
        f"{proven} when this page was printed: the normal form of left minus right is zero. {sentence} "
        f"Derived in `{page.file or page.name}`, printed by `symrot derive "
        f"{page.name}`; do not edit."
    )


def passage_equations(passage: Passage) -> Iterator[str]:
    """Yield the equations of a paragraph as LaTeX, ``left = right``.

    A pair with an empty left side continues the equation before it: ``= right``.
    """
    for left, right in passage.equations:
        yield f"{formula(left)} = {formula(right)}".lstrip()
