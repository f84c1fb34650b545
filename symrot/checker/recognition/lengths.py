"""The square of a vector's letter beside the vector's components: ``sigma^2`` beside sigma_1, sigma_2 and sigma_3.

Such a square is the sum of the squares of the components.
"""

import re
from collections.abc import Callable, Iterator
from dataclasses import replace

from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.reader import read_relation
from symrot.checker.claim.tree import TIME, Node, number, sum_of, text, walk
from symrot.checker.verdict import Verdict

__all__ = ["by_lengths"]

AXES = ("123", "xyz")
"""The indices of the components of a vector."""


def by_lengths(named: NamedFormula, judge: Callable[[NamedFormula], Verdict]) -> Verdict | None:
    """Return the verdict ``judge`` gives on a formula with sums of squares in place of squares of vectors' letters.

    The verdict's repairs have the squares again. None if there are no such squares, or if the verdict is "definition".
    """
    squares = dict(_squares(named.formula))
    if not squares:
        return None
    verdict = judge(named._replace(formula=_exchanged(named.formula, squares)))
    if verdict.verdict == "definition":
        return None
    back = {whole: square for square, whole in squares.items()}
    repairs = []
    for repair in verdict.repairs:
        _, left, right = read_relation(repair.text)
        repairs.append(replace(repair, text=f"{text(left)} == {text(_exchanged(right, back))}"))
    notes = tuple(_note(square, whole) for square, whole in squares.items())
    return replace(verdict, repairs=tuple(repairs), notes=(*verdict.notes, *notes))


def _note(square: Node, whole: Node) -> str:
    """Return the note for the user on a square that stands for the sum of squares ``whole``."""
    names = [str(term.args[0].value) for term in whole.args]
    return f"{square.args[0].value}^2 is read as the sum of the squares of {', '.join(names[:-1])} and {names[-1]}"


def _squares(formula: Node) -> Iterator[tuple[Node, Node]]:
    """Yield (``sigma**2``, sum of the squares of its components) for each letter that occurs only in its square."""
    letters = [
        node for _, node in walk(formula) if node.kind == "name" or (node.kind == "call" and node.args == (TIME,))
    ]
    for letter in dict.fromkeys(letters):
        square = Node("power", None, (letter, number(2)))
        if letters.count(letter) != sum(node == square for _, node in walk(formula)):
            continue
        for axes in AXES:
            pattern = rf"{re.escape(str(letter.value))}_?[{axes}]"
            parts = [other for other in dict.fromkeys(letters) if re.fullmatch(pattern, str(other.value))]
            if len(parts) > 1:
                stem = str(parts[0].value)[:-1]
                written = {part.value: part for part in parts}
                components = [written.get(stem + axis, Node("name", stem + axis)) for axis in axes]
                yield square, sum_of([Node("power", None, (part, number(2))) for part in components])


def _exchanged(tree: Node, trees: dict[Node, Node]) -> Node:
    if tree in trees:
        return trees[tree]
    return replace(tree, args=tuple(_exchanged(child, trees) for child in tree.args))
