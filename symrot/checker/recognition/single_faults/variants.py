"""Changes of one part of a formula that undo usual faults, each with the values of the part after the change."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from symrot.checker.claim.tree import Node, negated, number, product, sum_of
from symrot.checker.recognition.single_faults.parts import Correction, Letters, Values, near, rational, values_of
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.names import OPPOSITE, neighbours
from symrot.checker.repair.edits.trees import scaled, square_of, with_cofunctions

__all__ = ["FUNCTIONS", "LACKING", "Variant", "variants"]

POWERS = tuple(range(-2, 7))
"""Exponents that are tried in place of the exponent of a part of a formula, as x^3 for x^2; 0 is skipped."""
FUNCTIONS: dict[str, Callable[[float], float]] = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "cot": lambda x: 1 / math.tan(x),
    "sec": lambda x: 1 / math.cos(x), "csc": lambda x: 1 / math.sin(x),
}  # fmt: skip
LACKING = Node("name", "?")
"""Placeholder for a symbol of a known formula that a claim lacks: a name that no text can contain."""

MULTIPLES = {Fraction(2): "double_half_angle", Fraction(1, 2): "half_angle"}
"""Factor that is missing in an angle, as 2 in sin(x) for sin(2*x) -> the code of this fault."""


class Variant(NamedTuple):
    """A change of a formula's part that undoes a usual fault, and the changed part's values at the test points."""

    change: Correction
    values: Values


def variants(node: Node, parent: str, letters: Letters) -> list[Variant]:
    """Return the changes of the part ``node`` that undo usual faults, each with the part's values after the change.

    The values are those at the points of ``letters``; ``parent`` is the kind of the node above. The list is empty if
    the part is a matrix, or is zero or undefined at one of the points.
    """
    values = values_of(node, letters.points)
    if values is None or not all(isinstance(value, float) and value for value in values):
        return []
    made = [variant for kind in _VARIANTS for variant in kind(node, parent, values, letters)]
    return [
        variant for variant in made if all(map(math.isfinite, variant.values)) and not _equal(variant.values, values)
    ]


def _of_letter(node: Node, parent: str, values: Values, letters: Letters) -> Iterator[Variant]:
    """Yield all other symbols in ``letters`` as replacements of ``node``, if ``node`` is a symbol."""
    # as below, parent is the kind of the node around, values are those of node at the test points
    written = {**letters.atoms, **letters.aliases}
    if node not in written:
        return
    alike = neighbours(node.value, [str(n.value) for n in written if n.kind == "name"]) if node.kind == "name" else ()
    for other, others in written.items():
        if other != node:
            cost = COST["solved_neighbour" if other.value in alike or other == LACKING else "solved_symbol"]
            yield Variant(Correction(other, "wrong_symbol", cost), others)


def _of_exponent(node: Node, parent: str, values: Values, letters: Letters) -> Iterator[Variant]:
    """Yield replacements of a part by other powers: x and x^3 for x^2, or x for 1/x."""
    base, exponent = node, Fraction(1)
    if node.kind == "power" and node.args[1].kind == "number":
        base, exponent = node.args[0], node.args[1].value
    elif node.kind == "inv":
        cost = COST["factor"] + COST["quotient_inverted"]
        yield Variant(Correction(node.args[0], "factor", cost), tuple(1 / value for value in values))
        return
    elif not (node.kind in ("name", "call", "sum") and parent) and not (node.kind == "product" and parent == "inv"):
        return
    bases = values_of(base, letters.points) or ()
    if exponent == 2 and base in letters.atoms:  # x*y was written as x^2
        yield from _with_other_factor(base, bases, letters)
    for power in POWERS:
        if power != exponent and power and not (power < 0 and parent == "inv"):
            size = base if abs(power) == 1 else Node("power", None, (base, number(abs(power))))
            made = size if power > 0 else Node("inv", None, (size,))
            cost = COST["exponent"] + (0.0 if {power, exponent} == {1, 2} else COST["not_a_square"])
            try:
                powers = tuple(value**power for value in bases)
            except OverflowError:  # a number of hundreds of digits
                continue
            yield Variant(Correction(made, "exponent", cost), powers)


def _with_other_factor(base: Node, bases: Values, letters: Letters) -> Iterator[Variant]:
    """Yield the products of a symbol ``base`` and each other symbol, in place of its square: x*y for x^2."""
    alike = neighbours(base.value, letters.names) if base.kind == "name" else ()
    for other, others in letters.atoms.items():
        if other != base:
            cost = COST["solved_neighbour" if other.value in alike or other == LACKING else "solved_symbol"]
            made = Correction(product([base, other]), "wrong_symbol", cost)
            yield Variant(made, tuple(a * b for a, b in zip(bases, others, strict=True)))


def _of_square(node: Node, parent: str, values: Values, letters: Letters) -> Iterator[Variant]:
    """Yield (a/b)^2 for a part a/b, and a^2 - b^2 for a part (a - b)^2."""
    factors = [factor.args[0] if factor.kind == "inv" else factor for factor in node.args]
    if node.kind == "product" and len(factors) > 1 and parent == "sum" and all(f in letters.atoms for f in factors):
        squares = [square_of(factor) for factor in node.args]
        yield Variant(Correction(product(squares), "exponent", COST["exponent"]), tuple(v**2 for v in values))
    if node.kind == "power" and node.args[0].kind == "sum" and node.args[1] == number(2):
        terms = [negated(square_of(t.args[0])) if t.kind == "neg" else square_of(t) for t in node.args[0].args]
        made = sum_of(terms)
        changed = values_of(made, letters.points)
        if changed is not None:
            yield Variant(Correction(made, "exponent", COST["exponent"]), changed)


def _of_function(node: Node, parent: str, values: Values, letters: Letters) -> Iterator[Variant]:
    """Yield replacements of sin(u), such as cos(u), sin(2u) and sin(v), and likewise of cos(u), tan(u) and so on."""
    if node.kind != "call" or node.value not in FUNCTIONS:
        return
    (angle,) = node.args
    own = letters.angles[angle]
    if not all(own):
        return  # cot and csc have no value at 0
    for name in FUNCTIONS:
        cost = COST["sin_cos_swap"] + (0.0 if OPPOSITE[node.value] == name else COST["other_function"])
        yield Variant(Correction(replace(node, value=name), "sin_cos_swap", cost), tuple(map(FUNCTIONS[name], own)))
    for multiple, code in MULTIPLES.items():
        made = replace(node, args=(scaled(angle, multiple),))
        angles = tuple(float(multiple) * value for value in own)
        yield Variant(Correction(made, code, COST[code]), tuple(map(FUNCTIONS[node.value], angles)))
    for other, angles in (*letters.angles.items(), *((n, v) for n, v in letters.atoms.items() if n == LACKING)):
        if other != angle and rational(tuple(b / a for a, b in zip(own, angles, strict=True))) not in MULTIPLES:
            change = Correction(replace(node, args=(other,)), "wrong_symbol", COST["wrong_symbol"])
            yield Variant(change, tuple(map(FUNCTIONS[node.value], angles)))


def _of_factor(node: Node, parent: str, values: Values, letters: Letters) -> Iterator[Variant]:
    """Yield a term or bracket with one more symbol or function as factor or divisor, m*a and a/m for a; also b/a for
    a/b.
    """
    if parent in ("product", "power", "inv") or node.kind in ("neg", "inv", "number"):
        return
    if node.kind == "product":
        cost = COST["wrong_symbol"] + COST["quotient_inverted"]
        yield Variant(Correction(_inverted(node), "wrong_symbol", cost), tuple(1 / value for value in values))
    cost = COST["solved_factor"] + COST["per_piece_added"]
    for atom, factors in _factors(letters):
        for power in (1, -1, 2, -2) if all(factors) else (1, 2):
            factor = atom if abs(power) == 1 else square_of(atom)
            factor = factor if power > 0 else Node("inv", None, (factor,))
            made = tuple(value * other**power for value, other in zip(values, factors, strict=True))
            yield Variant(Correction(product([node, factor]), "factor", cost), made)


def _inverted(node: Node) -> Node:
    above = [part.args[0] for part in node.args if part.kind == "inv"]
    below = [Node("inv", None, (part,)) for part in node.args if part.kind != "inv"]
    return product([*above, *below])


def _factors(letters: Letters) -> Iterator[tuple[Node, Values]]:
    yield from letters.atoms.items()
    yield from letters.aliases.items()
    for angle, values in letters.angles.items():
        for name in ("sin", "cos", "tan"):
            yield Node("call", name, (angle,)), tuple(map(FUNCTIONS[name], values))


def _of_terms(node: Node, parent: str, values: Values, letters: Letters) -> Iterator[Variant]:
    """Yield replacements of a sum or product: a^2 + b^2 for a + b, or sine and cosine of an angle exchanged."""
    trees: list[tuple[Node, str]] = []
    if node.kind == "sum":
        bases = [_base(term) for term in node.args]
        if all(base is not None for base in bases):
            for power in POWERS[3:]:
                terms = [_powered(term, base, power) for term, base in zip(node.args, bases, strict=True) if base]
                trees.append((sum_of(terms), "exponent"))
    if node.kind in ("sum", "product"):
        trees += [(with_cofunctions(node, angle), "sin_cos_swap") for angle in letters.angles]
    for made, code in trees:
        changed = values_of(made, letters.points)
        if changed is not None and made != node:
            yield Variant(Correction(made, code, COST[code]), changed)


def _base(term: Node) -> Node | None:
    bare = term.args[0] if term.kind == "neg" else term
    bare = bare.args[0] if bare.kind == "power" else bare
    return bare if bare.kind == "name" else None


def _powered(term: Node, base: Node, power: int) -> Node:
    made = base if power == 1 else Node("power", None, (base, number(power)))
    return negated(made) if term.kind == "neg" else made


_VARIANTS = (_of_letter, _of_exponent, _of_square, _of_function, _of_factor, _of_terms)


def _equal(left: Values, right: Values) -> bool:
    return all(map(near, left, right))
