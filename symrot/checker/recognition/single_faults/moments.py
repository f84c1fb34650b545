"""Formulas that differ from a known one not by a fault, but because they are for another body or axis."""

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations, permutations

from symrot.checker.recognition.single_faults.parts import Letters, Values, near, rational
from symrot.checker.repair.rows import is_matrix

__all__ = ["is_shifted_moment", "is_symmetric_body"]

EQUAL_MOMENTS = (("A", "B"), ("B", "C"), ("I_xx", "I_yy"), ("I_yy", "I_zz"))
"""Pairs of moments of inertia that are equal in a symmetric body; the letter of the first one may stand for both."""
FIRST_EQUAL = (("A", "B"), ("I_xx", "I_yy"))
"""The pairs of ``EQUAL_MOMENTS`` that are equal if the third axis is the axis of symmetry."""


def is_symmetric_body(absent: str, letter: str, renaming: dict[str, str | None], times: int) -> bool:
    """Return whether a claim may use one letter for two equal moments of inertia: A in place of both A and B.

    ``absent`` is the known formula's symbol that the claim lacks, such as B. ``renaming`` maps the known symbols to the
    claim's letters. ``letter`` is the claim's letter in question; it occurs ``times`` times in the claim's formula.
    """
    # books write A for A = B; B stands for B = C only if it occurs once, as in A p^2 + B (q^2 + r^2)
    equal = EQUAL_MOMENTS if times == 1 else FIRST_EQUAL
    return any(absent == later and renaming.get(earlier) == letter for earlier, later in equal)


def is_shifted_moment(actual: Values, known: Values, letters: Letters) -> bool:
    """Return whether the values ``actual`` are those of a moment of inertia, ``known``, plus m d^2 (parallel axis).

    m is a letter of the claim. The distance d is a rational multiple of another letter, or has two such components.
    """
    if any(map(is_matrix, (*actual, *known))) or not all(known):
        return False
    ratios = [value / other for value, other in zip(actual, known, strict=True)]
    if min(ratios) <= 1:
        return False
    added = [value - other for value, other in zip(actual, known, strict=True)]
    for mass, *lengths in permutations(letters.atoms.values(), 2):
        if _are_squares([_share(added, mass, *lengths)]):
            return True
    return any(
        _are_squares(_shares(added, mass, pair))
        for mass in letters.atoms.values()
        for pair in combinations([length for length in letters.atoms.values() if length != mass], 2)
    )


def _share(added: Sequence[float], mass: Values, length: Values) -> Fraction | None:
    """Return the simple fraction k with ``added`` = k * ``mass`` * ``length``^2 at all test points, or None."""
    return rational([value / (m * d * d) for value, m, d in zip(added, mass, length, strict=True)])


def _shares(added: Sequence[float], mass: Values, lengths: Sequence[Values]) -> list[Fraction | None]:
    """Return simple fractions [k, l] with ``added`` = m (k a^2 + l b^2) at all points, for mass m and lengths a and b.

    If k or l is not a simple fraction, None stands in its place. If no numbers k and l fit, return [None].
    """
    (first, second, *_), rows = [value / m for value, m in zip(added, mass, strict=True)], [
        (a * a, b * b) for a, b in zip(*lengths, strict=True)
    ]  # fmt: skip
    (a, b), (c, d), *_ = rows
    below = a * d - b * c
    if not below:
        return [None]  # no such numbers
    shares = ((first * d - b * second) / below, (a * second - first * c) / below)
    fits = all(near(value / m, shares[0] * p + shares[1] * q)
               for value, m, (p, q) in zip(added, mass, rows, strict=True))  # fmt: skip
    return [rational([share]) for share in shares] if fits else [None]


def _are_squares(shares: Sequence[Fraction | None]) -> bool:
    return all(share is not None and share > 0 and _is_square(share) for share in shares)


def _is_square(share: Fraction) -> bool:
    """Return whether a fraction is the square of another fraction."""
    return all(math.isqrt(number) ** 2 == number for number in (share.numerator, share.denominator))
