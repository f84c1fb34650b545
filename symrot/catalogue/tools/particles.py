"""Sums over the particles of a body, in LaTeX: ``\\sum_i (m_i r_i)``."""

from collections.abc import Sequence
from typing import Any

from sympy import Expr, Matrix, Symbol

__all__ = ["sums_over"]

MASS = Symbol("m_i")
PLACE = Matrix([Symbol(f"r_i{axis}") for axis in "xyz"])


def sums_over(masses: Sequence[Expr], places: Sequence[Matrix]) -> dict[str, Any]:
    r"""Return the meanings of ``m_i``, ``r_i`` and ``\sum_i`` for :meth:`symrot.proof.derivation.Derivation.notation`.

    The sum stands before its terms in parentheses. ``masses`` and ``places`` are the masses and positions of the
    particles.

    Examples
    --------
    >>> from symrot.symbols import m_1, m_2
    >>> sums_over([m_1, m_2], [Matrix([0, 0, 1]), Matrix([0, 0, 2])])[r"\sum_i"](MASS * PLACE)[2]
    m_1 + 2*m_2
    """

    def total(term: Any) -> Any:
        terms = [
            term.subs({MASS: mass} | dict(zip(PLACE, place, strict=True)), simultaneous=True)
            for mass, place in zip(masses, places, strict=True)
        ]
        return sum(terms[1:], terms[0])

    return {"m_i": MASS, "r_i": PLACE, r"\sum_i": total}
