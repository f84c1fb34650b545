"""The known formulas and relations that a claim can mean (its readings), the likeliest first."""

from dataclasses import replace
from itertools import islice
from typing import Any

from sympy import Function, Matrix, Mul, Pow, Rational, Symbol, acos, asin, atan, atan2, fraction

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.interpreter import Interpreter, time
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.tree import Node, is_derivative, negated, sum_of, walk
from symrot.checker.context.context import letters_of
from symrot.checker.recognition.formulas.common_factors import terms_expanded, without_common_powers
from symrot.checker.recognition.identification import identified
from symrot.checker.recognition.known_formulas import ending_of
from symrot.checker.recognition.naming.fit import fits_context, fits_quantity, has_other_length, keeps_places
from symrot.checker.recognition.naming.quantities import names_in, quantity_name, words_of
from symrot.checker.recognition.naming.ranks import rarity_of, strangeness_of
from symrot.checker.verdict import Identification
from symrot.errors import InputError

__all__ = [
    "LEAST_SYMBOLS", "SQUARED", "all_letters_stated", "has_root_of_sum", "least_symbols_related", "readings_of_claim",
    "readings_of_formula", "readings_of_relation",
]  # fmt: skip

LEAST_SYMBOLS = 2
"""The smallest number of symbols in an unedited scalar formula of a claim that is looked up among the known formulas.

One symbol suffices if the quantity's name has a usual meaning, such as I_zz. For a formula that results from an edit of
the claim, the caller sets another number.
"""

LEAST_SYMBOLS_RELATED = 5
"""The smallest number of symbols in an equation that is compared with known relations (equations between quantities).

An equation with fewer symbols may equal a known relation by chance. The smaller number LEAST_SYMBOLS suffices in two
cases: the context says what each letter means, or the claim is compared without an edit and the name of its quantity
has no usual meaning.
"""

LEAST_SYMBOLS_OF_MOTION = 3
"""The smallest number of symbols in an equation of motion that is compared with known relations.

For instance, ``L*theta'' = -g*sin(theta)`` has three. An equation counts as an equation of motion if it has the second
time derivative of an angle, and a sine or cosine of the same angle.
"""

MOST_TERMS = 5000
"""An equation with more terms, after multiplying out, is not compared with known relations, which are all shorter."""

MOST_READINGS = 4
"""The largest number of known formulas or relations that `readings_of_formula` and `readings_of_relation` return."""

SQUARED = ", squared"
"""Ending of a known formula's name: "radius of gyration .., squared" is the name of a formula for k^2."""

SIGNED = ("angular velocity", "scalar component")
"""Beginnings of the names of quantities that may be negative.

For other quantities, such as a radius of gyration, a claim ``k = -sqrt(..)`` has a wrong sign.
"""


def least_symbols_related(left: Node, right: Node) -> int:
    """Return the smallest number of symbols with which ``left == right`` is compared with known relations."""
    nodes = [node for side in (left, right) for _, node in walk(side)]
    accelerated = {node.args[0] for node in nodes if is_derivative(node) and len(node.args) > 2}
    # an equation of motion, such as L theta'' = -g sin theta, needs fewer than another equation
    of_motion = any(
        node.kind == "call" and node.value in ("sin", "cos") and accelerated & {*node.args} for node in nodes
    )
    return LEAST_SYMBOLS_OF_MOTION if of_motion else LEAST_SYMBOLS_RELATED


def readings_of_claim(
    claim: Claim, named: NamedFormula, tree: Node, least_symbols: int, interpreter: Interpreter | None = None
) -> tuple[Identification, ...]:
    """Return the known formulas that a claim with the right side ``tree`` can mean, the likeliest first.

    If there are none, return the known relations (equations between quantities) that the whole claim can mean. At most
    MOST_READINGS are returned.

    A scalar ``tree`` with fewer than ``least_symbols`` symbols is not compared with known formulas. Callers pass
    LEAST_SYMBOLS for the formula as the claim states it; then one symbol suffices if the quantity's name has a usual
    meaning, such as I_zz. For an edited formula, callers pass another number. An equation needs more symbols to be
    compared with relations: see `LEAST_SYMBOLS_RELATED`. ``interpreter`` turns trees into SymPy values; by default, the
    claim makes it.
    """
    interpreter = claim.interpreter() if interpreter is None else interpreter
    solved: tuple[Identification, ...] = ()
    if named.solve is not None:
        solved = readings_of_formula(claim, named, named.solve(tree), least_symbols, interpreter)
    is_open = all_letters_stated(claim, named) or (words_of(named) is None and least_symbols == LEAST_SYMBOLS)
    least = LEAST_SYMBOLS if is_open else least_symbols_related(named.side, tree)
    return solved or readings_of_relation(claim, named, tree, least, interpreter)


def all_letters_stated(claim: Claim, named: NamedFormula) -> bool:
    """Return whether the context says what each letter of a claim means."""
    letters = names_in(named.side) | names_in(named.formula)
    return bool(letters) and all(claim.context.meaning_of(letter) is not None for letter in letters)


def readings_of_relation(
    claim: Claim, named: NamedFormula, tree: Node, least_symbols: int, interpreter: Interpreter | None = None
) -> tuple[Identification, ...]:
    """Return the known relations, MOST_READINGS at most, that are equivalent to the equation ``named.side == tree``.

    Empty if the equation cannot be read or has fewer than ``least_symbols`` symbols; also for matrices, roots of sums
    and long equations.
    """
    difference = sum_of([named.side, negated(tree)])
    try:
        value = claim.with_definitions((interpreter or claim.interpreter()).read(difference))
    except InputError:
        return ()
    if is_matrix(value) or len(value.atoms(Function, Symbol) - {time}) < least_symbols:
        return ()
    if terms_expanded(value) > MOST_TERMS or has_root_of_sum(value):
        return ()
    value = without_common_powers(value)
    letters = {*letters_of(tree), *letters_of(named.side)}

    def fits(known: Identification) -> bool:
        return keeps_places(named, known) and fits_context(claim.context, named, known, letters)

    fitting = identified(value, steps=False, named=True, quantity="", is_relation=True, fits=fits)
    return tuple(islice(fitting, MOST_READINGS))


def has_root_of_sum(value: Any) -> bool:
    """Return whether a formula contains the root of a sum, which no known relation does."""
    return any(power.base.is_Add and not power.exp.is_Integer for power in value.atoms(Pow))


def readings_of_formula(
    claim: Claim, named: NamedFormula, formula: Node, least_symbols: int, interpreter: Interpreter | None = None
) -> tuple[Identification, ...]:
    """Return the likeliest known formulas for the claim's quantity that are equal to ``formula``.

    Empty if ``formula`` cannot be read, or is a scalar with fewer than ``least_symbols`` symbols. A single symbol
    suffices if the formula is unedited, for which callers pass LEAST_SYMBOLS, and the quantity's name has a usual
    meaning, such as I_zz. An edited formula that short may equal a known one by chance.
    """
    try:
        value = claim.with_definitions((interpreter or claim.interpreter()).read(formula))
    except InputError:
        return ()
    if is_matrix(value) and value.shape == (1, 1):
        value = value[0]
    # one symbol suffices in the claim's own formula if books use the name for one thing, as I_zz;
    # a short formula that results from an edit may equal a known one by chance
    fewest = 1 if words_of(named) is not None and least_symbols == LEAST_SYMBOLS else least_symbols
    if not is_matrix(value) and len(value.atoms(Function, Symbol) - {time}) < fewest:
        return ()
    letters = {*letters_of(formula)}
    is_tangent = named.side.kind == "call" and named.side.value == "tan"
    searched, ending = _without_function(value, is_tangent)
    is_negative = ending == SQUARED and value.as_coeff_Mul()[0] < 0

    def fits(known: Identification) -> bool:
        return (
            ending_of(known.name) == ending
            and not (is_negative and not known.name.startswith(SIGNED))
            and fits_quantity(named, known, is_matrix(value))
            and fits_context(claim.context, named, replace(known, name=known.name.removesuffix(ending)), letters)
            and not has_other_length(known.name, known.mapping.items())
        )

    is_named = words_of(named) is not None
    looked_up = identified(searched, steps=False, named=is_named, quantity=quantity_name(named), fits=fits)
    fitting = [replace(known, name=known.name.removesuffix(ending)) for known in looked_up]
    fitting.sort(key=lambda known: (*strangeness_of(named, known), rarity_of(known)))
    likeliest = [
        known for known in fitting if strangeness_of(named, known)[:2] == strangeness_of(named, fitting[0])[:2]
    ]
    return tuple(likeliest[:MOST_READINGS])


def _without_function(value: Any, of_tangent: bool = False) -> tuple[Any, str]:
    """Return a formula without its outer inverse function or root, and a word for this function: (u, ", acos").

    The known formulas are stored in the same way: one for an angle acos(u) is stored as u, with ", acos" at the end of
    its name. ``2*acos(u)`` gives (u, ", 2 acos"), likewise asin and atan2; ``a*sqrt(u)`` gives (a**2*u, ", squared")
    and ``a/sqrt(u)`` gives (a**2/u, ", squared"). Any other ``value`` gives (value, ""). With ``of_tangent``, for a
    claim ``tan(x) = a/b``, ``atan(a/b)`` gives (Matrix([a, b]), ", atan2").
    """
    if is_matrix(value):
        return value, ""
    # known formulas with roots and inverse functions are stored without them; the words end their names
    if any(abs(power.exp) == Rational(1, 2) for power in Mul.make_args(value) if power.is_Pow):
        return value**2, SQUARED
    factor, function = value.as_coeff_Mul()
    if of_tangent and isinstance(function, atan) and factor == 1:
        return Matrix(fraction(function.args[0])), ", atan2"
    if not isinstance(function, acos | asin | atan2):
        return value, ""
    if factor < 0 and isinstance(function, asin):
        factor, function = -factor, asin(-function.args[0], evaluate=False)  # asin is odd: -asin(u) is asin(-u)
    inside = Matrix(function.args) if isinstance(function, atan2) else function.args[0]
    return inside, f", {f'{factor} ' * (factor != 1)}{function.func}"
