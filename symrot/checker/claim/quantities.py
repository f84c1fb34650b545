"""The letters I, E, e and i: in some books each is a quantity (inertia, energy), in others a number (i, 2.718..)."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.tree import Node, nodes_of

__all__ = [
    "OTHER_MEANINGS", "has_natural_base", "letters_of_quantities", "with_natural_base",
]  # fmt: skip

OTHER_MEANINGS = {"I": "the imaginary unit", "E": "the number e = 2.718.."}
"""Maps each letter that is a quantity in mechanics, and a number in SymPy, to words for the number."""

OF_NUMBERS = frozenset(BUILT_IN) - {
    "sqrt", "abs", "diff", "integrate", "Matrix", "diag", "hstack", "cross", "dot", "skew", "trace", "det", "transpose",
}  # fmt: skip
"""Functions whose argument is never a moment of inertia or an energy."""

USUAL_QUANTITIES = frozenset("mMgGhlLrRvFkTVUKJHNpqsabdcw")


def letters_of_quantities(trees: Sequence[Node]) -> tuple[str, ...]:
    """Return those of the letters I and E that name a moment of inertia or an energy in ``trees``, not the numbers i
    and e.
    """
    nodes = nodes_of(*trees)
    names = {
        str(node.value) for node in nodes if node.kind == "name" or (node.kind == "call" and node.value not in BUILT_IN)
    }
    others = names - set(OTHER_MEANINGS)
    sides = [tree for tree in trees if tree.kind == "name" and tree.value in OTHER_MEANINGS]
    if not others and sides and {*sides} == {sides[0]} and nodes.count(sides[0]) == len(sides):
        return (str(sides[0].value),)  # I = 0.5*2*0.1^2
    # without another usual name of mechanics, I and E are numbers
    if not any(
        name in USUAL_QUANTITIES or (len(name) > 1 and name not in ("pi", "theta", "phi", "psi")) for name in others
    ):
        return ()
    letters = []
    below = [part for node in nodes if node.kind == "inv" for part in node.args]
    for letter in OTHER_MEANINGS:
        # a number: inside exp, log or sin, in a product with sines only, or as the base of E^(a t)
        used = [node for node in nodes if node == Node("name", letter)]
        calls = [node for node in nodes if node.kind == "call" and node.value in OF_NUMBERS]
        inside = nodes_of(*calls)
        waves = [node for node in nodes if _is_exponential(node, letter)]
        waves += [
            node for node in nodes if node.kind == "product" and node not in below and _is_imaginary(node, letter)
        ]
        if used and not waves and not any(node == Node("name", letter) for node in inside):
            letters.append(letter)
    return tuple(letters)


def _is_imaginary(product: Node, letter: str) -> bool:
    """Return whether a product multiplies ``letter`` by sin, cos or sinh and by numbers only, as in ``2*I*sin(x)``."""
    others = [factor for factor in product.args if (factor.kind, factor.value) != ("name", letter)]
    pure = all(
        factor.kind == "number" or (factor.kind == "call" and factor.value in ("sin", "cos", "sinh"))
        for factor in others
    )
    return len(others) < len(product.args) and pure and any(factor.kind == "call" for factor in others)


def has_natural_base(trees: Sequence[Node]) -> bool:
    """Return whether e is the base of the exponential function, as in ``e^x`` or ``log(e)``."""
    nodes = nodes_of(*trees)
    logarithms = (node.args[0] for node in nodes if node.kind == "call" and node.value == "log")
    of_e = any(e.value == "e" for argument in logarithms for e in (argument, *argument.args[:1]) if e.kind == "name")
    # in e^2 and e*x, e may be an eccentricity
    return of_e or any(_is_exponential(node, "e") for node in nodes)


def _is_exponential(node: Node, base: str) -> bool:
    if node.kind != "power" or (node.args[0].kind, node.args[0].value) != ("name", base):
        return False
    return any(part.kind in ("name", "call") for part in nodes_of(node.args[1]))


def with_natural_base(node: Node) -> Node:
    """Return a tree in which e is the base of the exponential function: exp(x) for e**x, exp(1) for e alone."""
    if node.kind == "power" and (node.args[0].kind, node.args[0].value) == ("name", "e"):
        return Node("call", "exp", (with_natural_base(node.args[1]),), node.span)
    if node == Node("name", "e"):
        return Node("call", "exp", (Node("number", Fraction(1)),), node.span)
    return replace(node, args=tuple(map(with_natural_base, node.args)))
