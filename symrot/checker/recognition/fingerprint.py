"""Fingerprints of formulas: hashes that do not depend on the names of symbols.

Formulas are evaluated modulo the prime 2^61 - 1, where equal functions have equal values. The signature of an atom
(a symbol, function or derivative) is the formula's value where this atom has one number and all others have another.
The sorted signatures are the fingerprint.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256

import sympy
from sympy import Expr, Mul, Rational, S, cancel

from symrot.checker.claim.interpreter import atoms_of

__all__ = ["PRIME", "Fingerprint", "NotInField", "Values", "fingerprint", "in_lowest_terms", "values_at"]

PRIME = 2**61 - 1  # different functions agree at a random point with a probability of 1e-18
"""The number of elements of the field in which formulas are evaluated, a prime that is 3 modulo 4.

Modulo such a prime, 1 + u^2 is never 0, so that (1 - u^2)/(1 + u^2) always exists as a cosine; and the square root of a
value is simply its power (PRIME + 1)/4.
"""
DRAWS = tuple((pow(3, 101 + 2 * n, PRIME), pow(3, 102 + 2 * n, PRIME)) for n in range(48))
"""Pairs (value of one symbol, value of all other symbols), tried in turn until the formula is defined."""
MOST_UNDEFINED = 3
"""The largest number of pairs in DRAWS with which a formula is evaluated. After that, it is evaluated in another way.

A pair gives its first number to one symbol and its second number to all other symbols. A formula such as x/(A - B),
which is undefined for all these pairs, is probably undefined wherever two symbols are equal."""
PARTS = 4
"""The number of parts into which an angle x is divided: cos(x) and sin(x) are computed from cos(x/4) and sin(x/4), so
that cosines and sines of x/2 and x/4 have values too."""
MOST_CANCELLED = 10
"""The largest number of atoms in a formula whose fractions are cancelled. For the inverse of a tensor, which has more,
this would take seconds.
"""
LARGEST_MULTIPLE = 400
"""The largest n for which cos(n*x/4), sin(n*x/4) and x**n are evaluated. A formula with a larger n has no value modulo
``PRIME``, and so is never recognised."""

Values = tuple[int, ...]
"""The values of a formula's entries modulo ``PRIME``."""


class NotInField(Exception):
    """Exception for a formula that has no value in the finite field, for example after a division by zero."""


def values_at(entries: Sequence[Expr], point: Mapping[Expr, int]) -> Values:
    """Return the values of a formula's entries at a point, in the field of the integers modulo ``PRIME``.

    Raises
    ------
    NotInField
        For divisions by zero, and for functions that cannot be evaluated in the field, such as exp.
    """
    known: dict[Expr, int] = dict(point)
    return tuple(_value(entry, known) for entry in entries)


def _value(node: Expr, known: dict[Expr, int]) -> int:
    if node not in known:
        known[node] = _computed(node, known) % PRIME
    return known[node]


def _computed(node: Expr, known: dict[Expr, int]) -> int:
    if node.is_Rational:
        return int(node.p) * _inverse(int(node.q))
    if node.is_Add:
        return sum(_value(term, known) for term in node.args)
    if node.is_Mul:
        total = 1
        for factor in node.args:
            total = total * _value(factor, known) % PRIME
        return total
    if node.is_Pow and node.exp.is_Rational:
        return _power(_value(node.base, known), node.exp)
    if isinstance(node, sympy.Abs):
        return _root(_value(node.args[0], known) ** 2)
    if node is S.Pi:
        return _pseudorandom(227)
    if type(node) in _CIRCULAR:
        above, below = _CIRCULAR[type(node)]
        point = _circle_point(node.args[0], known)
        return (point[above] if above is not None else 1) * (_inverse(point[below]) if below is not None else 1)
    raise NotInField


_CIRCULAR = {
    sympy.cos: (0, None), sympy.sin: (1, None), sympy.tan: (1, 0), sympy.cot: (0, 1), sympy.sec: (None, 0),
    sympy.csc: (None, 1),
}  # fmt: skip


def _inverse(value: int) -> int:
    if not value % PRIME:
        raise NotInField
    return pow(value, -1, PRIME)


def _root(value: int) -> int:
    """Return a square root of ``value`` modulo ``PRIME``, or of ``-value`` if ``value`` is no square."""
    # always the smaller root, so that equal formulas under roots have equal values
    root = pow(value % PRIME, (PRIME + 1) // 4, PRIME)
    return min(root, PRIME - root)


def _power(base: int, exponent: Rational) -> int:
    if exponent.q not in (1, 2) or abs(exponent.p) > LARGEST_MULTIPLE:
        raise NotInField
    base = _root(base) if exponent.q == 2 else base
    power = int(exponent.p)
    return pow(base, power, PRIME) if power >= 0 else pow(_inverse(base), -power, PRIME)


def _pseudorandom(value: int) -> int:
    """Return a pseudorandom field element computed from ``value``."""
    return pow(value + 1_000_003, 65_537, PRIME)


def _circle_point(argument: Expr, known: dict[Expr, int]) -> tuple[int, int]:
    """Return (c, s) with c^2 + s^2 = 1 modulo ``PRIME``, used as cosine and sine of the angle ``argument``."""
    # the angle is a sum of multiples of symbols; the theorems for sums and multiples of angles hold
    total = (1, 0)
    for term in sympy.Add.make_args(sympy.expand(argument)):
        coefficient, angle = term.as_coeff_Mul()
        if not coefficient.is_Rational or angle is S.One:
            raise NotInField
        parts = coefficient * (2 if angle is S.Pi else PARTS)
        if not parts.is_Integer or abs(parts) > LARGEST_MULTIPLE:
            raise NotInField
        if angle is S.Pi:
            point = (0, 1)
        else:
            # hashed, so that cos and sin of an angle have no algebraic relation to the value of the angle itself
            u = _pseudorandom(_value(angle, known))
            below = _inverse(1 + u * u)
            point = ((1 - u * u) * below % PRIME, 2 * u * below % PRIME)
        if parts < 0:
            point = (point[0], -point[1])
        for _ in range(abs(int(parts))):
            total = _added(total, point)
    return total


def _added(first: tuple[int, int], second: tuple[int, int]) -> tuple[int, int]:
    (a, b), (c, d) = first, second
    return (a * c - b * d) % PRIME, (a * d + b * c) % PRIME


@dataclass(frozen=True)
class Fingerprint:
    """The atoms (symbols, functions, derivatives) of a formula, each with its signature.

    The signature of an atom is the values of the formula's entries where the atom has one number and all other atoms
    have another number.
    """

    atoms: tuple[Expr, ...]
    signatures: tuple[Values, ...]
    idle: tuple[Expr, ...] = ()  # atoms in the formula that do not change its value

    def scaled_signatures(self, order: Sequence[int]) -> list[Values]:
        """Return the signature of each atom, scaled so that the formulas x and 2*x have the same signatures.

        A signature has one value for each entry of a matrix formula, or one value for a scalar formula. ``order`` are
        the indices of the entries in the order in which their values are returned. All values are divided by the sum of
        the atoms' values for one entry, the first entry in this order for which the sum is not zero.
        """
        total = [sum(column) % PRIME for column in zip(*self.signatures, strict=True)]
        # the first entry whose values have a nonzero sum
        below = _inverse(next((total[n] for n in order if total[n]), 1))
        return [tuple(values[n] * below % PRIME for n in order) for values in self.signatures]

    def key(self, shape: tuple[int, int] | None, order: Sequence[int]) -> str:
        """Return a hash of the formula, with its entries in ``order`` and this ``shape`` (None for a scalar).

        The hash depends neither on the names of symbols nor on a constant factor.
        """
        return sha256(repr((shape, sorted(self.scaled_signatures(order)))).encode()).hexdigest()[:16]


def fingerprint(entries: Sequence[Expr]) -> Fingerprint:
    """Return the fingerprint of a formula: its atoms, each with a signature that does not depend on their names.

    ``entries`` are the entries of a matrix, or the one entry of a scalar formula.

    Raises
    ------
    NotInField
        For a formula whose value depends on no symbol, or one that cannot be evaluated modulo ``PRIME``.
    """
    written = sorted(atoms_of(entries), key=str)
    if (alike := _from_one_draw(entries, written)) is not None:
        return alike
    atoms = _active(entries, written)
    if not atoms:
        raise NotInField
    for raised, others in DRAWS[:MOST_UNDEFINED]:
        point = dict.fromkeys(written, others)
        try:
            rows = [values_at(entries, {**point, atom: raised}) for atom in atoms]
        except NotInField:
            continue
        return Fingerprint(tuple(atoms), tuple(rows), tuple(atom for atom in written if atom not in atoms))
    if len(written) > MOST_CANCELLED:
        raise NotInField
    cancelled = [entry if in_lowest_terms(entry) else cancel(entry) for entry in entries]
    if cancelled != list(entries):
        return fingerprint(cancelled)
    # x/(A - B) has no value where two atoms are equal
    rows = [_sum_over_pairs(entries, atom, atoms, written) for atom in atoms]
    return Fingerprint(tuple(atoms), tuple(rows), tuple(atom for atom in written if atom not in atoms))


def in_lowest_terms(formula: Expr) -> bool:
    """Return whether a product is proven to be in lowest terms.

    The product ``(a**2 - b**2)/(a - b)`` is not, because its divisor a - b divides its numerator. The test evaluates
    the rest of the formula modulo ``PRIME`` at a zero of each divisor. Return False also if the test cannot tell: for a
    divisor that is not linear in any symbol, function or derivative, and for a formula without a value modulo
    ``PRIME``, such as exp(x).
    """
    # quicker than cancel: a divisor that is linear in x divides the rest only if the rest is 0 at its root
    atoms = sorted(atoms_of([formula]), key=str)
    point = {atom: _pseudorandom(n) for n, atom in enumerate(atoms)}
    powers = [factor for factor in Mul.make_args(formula) if factor.is_Pow and factor.exp.could_extract_minus_sign()]
    rest = Mul(*(factor for factor in Mul.make_args(formula) if factor not in powers))
    try:
        return all(_misses(rest, power.base, point) for power in powers)
    except NotInField:
        return False


def _misses(rest: Expr, divisor: Expr, point: Mapping[Expr, int]) -> bool:
    for atom in sorted(atoms_of([divisor]), key=str):
        values = [values_at([divisor], {**point, atom: value})[0] for value in range(3)]
        slope = (values[1] - values[0]) % PRIME
        if slope and (values[2] - values[1]) % PRIME == slope:
            root = -values[0] * _inverse(slope) % PRIME
            return values_at([rest], {**point, atom: root}) != (0,)
    return False


def _from_one_draw(entries: Sequence[Expr], written: Sequence[Expr]) -> Fingerprint | None:
    """Return the :class:`Fingerprint` of a formula, evaluated with the first pair of numbers in DRAWS, or None.

    ``entries`` are the entries of a matrix, or the one entry of a scalar formula; ``written`` are its atoms (symbols,
    functions, derivatives). Return None if the formula has no value for this pair, or does not change with one of its
    atoms: the caller then tries other pairs of numbers.
    """
    raised, others = DRAWS[0]
    point = dict.fromkeys(written, others)
    here = _defined(entries, point)  # 1/(x - y) has no value here
    if here is None or not written:
        return None
    rows = []
    for atom in written:
        row = _defined(entries, {**point, atom: raised})
        if row is None or row == here:
            return None  # here the atom may be idle: the caller finds out
        rows.append(row)
    return Fingerprint(tuple(written), tuple(rows))


def _sum_over_pairs(entries: Sequence[Expr], atom: Expr, atoms: Sequence[Expr], written: Sequence[Expr]) -> Values:
    """Return the signature of ``atom`` for a formula that is undefined where two atoms are equal, such as x/(A - B).

    ``atoms`` are the symbols that change the value of the formula, ``written`` all its symbols. For each b in ``atoms``
    other than ``atom``, the formula is evaluated with one number for ``atom``, a second for b and a third for all other
    symbols. The signature is the sum of these values, without undefined ones. Raise NotInField if all are undefined.
    """
    raised, others = DRAWS[0]
    second, _ = DRAWS[1]
    # one point for each other atom
    points = (dict.fromkeys(written, others) | {atom: raised, other: second} for other in atoms if other != atom)
    defined = [values for point in points if (values := _defined(entries, point)) is not None]
    if not defined:
        raise NotInField
    # a sum does not depend on the order of the atoms
    return tuple(sum(column) % PRIME for column in zip(*defined, strict=True))


def _active(entries: Sequence[Expr], atoms: Sequence[Expr]) -> list[Expr]:
    """Return the ``atoms`` that change the value of a formula: x, but not y, for ``x*y/y``."""
    for first, _ in DRAWS:
        point = {atom: pow(first, n * n + 2, PRIME) for n, atom in enumerate(atoms)}  # no cross product is zero
        here = _defined(entries, point)
        if here is not None:
            break
    else:
        raise NotInField
    return [atom for atom in atoms if _moves(entries, point, atom, here)]


def _moves(entries: Sequence[Expr], point: Mapping[Expr, int], atom: Expr, here: Values) -> bool:
    beside = (_defined(entries, {**point, atom: second}) for _, second in DRAWS)
    return next((values != here for values in beside if values is not None), True)


def _defined(entries: Sequence[Expr], point: Mapping[Expr, int]) -> Values | None:
    try:
        return values_at(entries, point)
    except NotInField:
        return None
