"""A relation of mechanics: an equation between quantities, which books solve for one quantity or another."""

from collections.abc import Iterator
from typing import Any, NamedTuple

from sympy import Expr, Poly, Symbol, cancel, factor_terms, fraction, together

__all__ = ["Relation", "solved"]


class Relation(NamedTuple):
    """A relation of mechanics: the left side minus the right side, and the symbols for which to solve it."""

    title: str
    source: str  # the derivation page
    difference: Expr
    words: dict[Symbol, str]  # {E: "energy of"} names the formula for E "energy of" and the title


def solved(relation: Relation) -> Iterator[tuple[str, str, Any]]:
    """Solve a relation for each symbol in ``relation.words``; yield (name, source, formula) for each symbol.

    The source is the page with the derivation, such as ``derivations/heavy_top.md``.

    If the relation has only the square of a symbol, the formula is for the square, and its name ends with ", squared".
    Symbols in higher powers, or in first power and square, are skipped.
    """
    numerator = fraction(together(relation.difference))[0]
    for symbol, words in relation.words.items():
        coefficients = Poly(numerator, symbol).all_coeffs()
        if len(coefficients) == 2:
            slope, rest = coefficients
            name = f"{words} {relation.title}"
        elif len(coefficients) == 3 and coefficients[1] == 0:
            slope, _, rest = coefficients
            name = f"{words} {relation.title}, squared"
        else:
            continue  # neither linear nor purely quadratic in the symbol
        yield name, relation.source, factor_terms(cancel(-rest / slope))
