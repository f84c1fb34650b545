"""Simplified arguments of functions: ``sin(sin(x)^2 + cos(x)^2) = sin(1)``.

A polynomial ring may have one variable for each of two equal calls that are written differently, such as ``asin(1/3)``
and ``asin(sin(x)^2/3 + cos(x)^2/3)``. So arguments of functions are first replaced by their normal forms, computed in
polynomial rings. Old and new formula are equal wherever no divisor in these rings is zero. The functions of this module
return the rings. Of their own parameters, ``hypotheses`` are expressions that are zero, and ``domain`` are formulas
that are nonnegative wherever the formulas are defined.
"""

from collections.abc import Sequence

import sympy
from sympy import Expr, Pow

from symrot.exact.angles.inverse import INVERSE
from symrot.exact.functions import REWRITTEN, TRIGONOMETRIC
from symrot.exact.inverse_sums import proof
from symrot.exact.ring.ring import FormulaRing

__all__ = ["proof_by_arguments", "with_plain_arguments"]

FUNCTIONS = (*TRIGONOMETRIC, *REWRITTEN, *INVERSE, sympy.exp, sympy.log, sympy.Abs)

MOST_LEVELS = 4
"""Number of levels of nested functions, counted from the innermost, at which arguments are put in normal form.

In ``sin(cos(x))``, the cosine is the first level and the sine the second."""

MOST_COMPARED = 8
"""Largest number of arguments of functions, such as u in sin(u), of which all pairs are tested for equality."""


def with_plain_arguments(
    formulas: Sequence[Expr], hypotheses: Sequence[Expr] = (), domain: Sequence[Expr] = ()
) -> tuple[list[Expr], tuple[FormulaRing, ...]]:
    """Return the formulas with all arguments of functions in normal form, and the rings in which this was computed.

    ``sin(sin(x)^2 + cos(x)^2)`` becomes ``sin(1)``. Arguments of functions without a definition, such as f(t), stay.
    ``hypotheses`` are expressions that are zero, such as ``q0^2 + q1^2 + q2^2 + q3^2 - 1``; ``domain`` are formulas
    that are nonnegative wherever ``formulas`` are defined. Both serve to shorten the arguments.
    """
    formulas, rings = list(formulas), []
    for level in range(MOST_LEVELS):
        nodes = [node for node in _functions(formulas) if _level(node) == level]
        arguments = sorted({argument for node in nodes for argument in node.args}, key=sympy.default_sort_key)
        if not any(map(_is_compound, arguments)):
            continue
        ring = FormulaRing(arguments, hypotheses, domain)
        shorter, further = _common_forms(ring, arguments)
        values = {node: node.func(*(shorter[argument] for argument in node.args)) for node in nodes}
        formulas = [formula.xreplace(values) for formula in formulas]
        rings += [ring, *further]
    return formulas, tuple(rings)


def _common_forms(ring: FormulaRing, arguments: Sequence[Expr]) -> tuple[dict[Expr, Expr], tuple[FormulaRing, ...]]:
    """Return (forms, rings): a map from arguments of functions, such as u in sin(u), to their normal forms in ``ring``.

    Arguments that are proven equal get the same form, the normal form of the first. ``rings`` are the further
    polynomial rings in which these proofs were computed; the proofs hold wherever no divisor in them is zero.
    """
    shorter: dict[Expr, Expr] = {}
    rings: list[FormulaRing] = []
    for argument in arguments:
        shorter[argument] = ring.expression(ring.ratio(argument))
        for other in list(shorter)[:-1] if len(arguments) <= MOST_COMPARED else ():
            further = proof(ring, ring.difference(argument, other).numerator)
            if further is not None:
                shorter[argument] = shorter[other]
                rings += further
                break
    return shorter, tuple(rings)


def proof_by_arguments(
    left: Expr, right: Expr, hypotheses: Sequence[Expr], domain: Sequence[Expr]
) -> tuple[FormulaRing, ...] | None:
    """Prove ``left = right`` with all arguments of functions in normal form.

    Return the polynomial rings that the proof uses, or None if no proof is found. ``hypotheses`` are expressions that
    are zero, and ``domain`` are formulas that are nonnegative wherever both sides are defined.
    """
    (shorter, other), rings = with_plain_arguments([left, right], hypotheses, domain)
    # no argument changes: the proof was tried before
    if (shorter, other) == (left, right):
        return None
    ring = FormulaRing([shorter, other], hypotheses, domain)
    further = proof(ring, ring.difference(shorter, other).numerator)
    return None if further is None else (*rings, ring, *further)


def _functions(formulas: Sequence[Expr]) -> set[Expr]:
    return {node for formula in formulas for node in formula.atoms(*FUNCTIONS)}


def _level(node: Expr) -> int:
    """Return how many functions are nested inside the arguments of the function ``node``.

    It is 0 for sin(x), and 1 for sin(cos(x)).
    """
    return max(map(_depth, node.args))


def _depth(formula: Expr) -> int:
    return isinstance(formula, FUNCTIONS) + max(map(_depth, formula.args), default=0)


def _is_compound(argument: Expr) -> bool:
    """Return whether an argument contains a function, a root or a divisor, so that a normal form may shorten it."""
    return bool(argument.atoms(*FUNCTIONS)) or any(
        not (power.exp.is_Integer and power.exp > 0) for power in argument.atoms(Pow)
    )
