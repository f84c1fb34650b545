"""The letters I and E, which name a quantity in books on mechanics and a number in SymPy."""

from collections.abc import Sequence

from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.tree import Node, walk

__all__ = ["OTHER_MEANINGS", "letters_of_quantities"]

OTHER_MEANINGS = {"I": "the imaginary unit", "E": "the number e = 2.718.."}
"""Letters that name a quantity in books on mechanics, and a number in SymPy -> the number in words."""

USUAL_QUANTITIES = frozenset("mMgGhlLrRvFkTVUKJHNpqsabdcw")


def letters_of_quantities(trees: Sequence[Node]) -> tuple[str, ...]:
    """Return the letters I and E of trees in which they are quantities, an inertia and an energy.

    They are, next to another name that books on mechanics use, unless they are where only a number makes sense: inside
    of exp, log or a trigonometric function, or as the factor of nothing but a sine.
    """
    nodes = [node for tree in trees for _, node in walk(tree)]
    names = {
        str(node.value) for node in nodes if node.kind == "name" or (node.kind == "call" and node.value not in BUILT_IN)
    }
    others = names - set(OTHER_MEANINGS)
    if not any(
        name in USUAL_QUANTITIES or (len(name) > 1 and name not in ("pi", "theta", "phi", "psi")) for name in others
    ):
        return ()
    letters = []
    for letter in OTHER_MEANINGS:
        used = [node for node in nodes if (node.kind, node.value) == ("name", letter)]
        inside = [node for call in nodes if call.kind == "call" and call.value in BUILT_IN and call.value not in
                  ("sqrt", "abs", "diff", "integrate", "Matrix", "diag") for _, node in walk(call)]  # fmt: skip
        waves = [node for node in nodes if node.kind == "product" and _is_imaginary(node, letter)]
        if used and not waves and not any((node.kind, node.value) == ("name", letter) for node in inside):
            letters.append(letter)
    return tuple(letters)


def _is_imaginary(product: Node, letter: str) -> bool:
    """Return whether a product has only the letter, numbers, and sines: I*sin(theta)."""
    others = [factor for factor in product.args if (factor.kind, factor.value) != ("name", letter)]
    pure = all(
        factor.kind == "number" or (factor.kind == "call" and factor.value in ("sin", "cos", "sinh"))
        for factor in others
    )
    return len(others) < len(product.args) and pure and any(factor.kind == "call" for factor in others)
