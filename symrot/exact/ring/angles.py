"""Sines and cosines of angles, as fractions of polynomials in the sines and cosines of base angles.

With ``theta/2`` as base angle, the cosine of theta is ``2 cos(theta/2)^2 - 1``.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from sympy import Expr, pi

from symrot.exact.angles import cyclotomic
from symrot.exact.angles.angles import LinearForm, chebyshev, constant_cosine_sine
from symrot.exact.angles.inverse import cosine_sine
from symrot.exact.angles.known_angles import halved, is_known_angle
from symrot.exact.ring.polynomials import univariate
from symrot.exact.ring.ratio import Ratio, Ratios, TooLarge

__all__ = ["Angles"]

MOST_MULTIPLES = 240
"""Largest n for which the sine and cosine of n times a base angle are expanded.

For a base angle that is a fraction of pi, such as pi/7, the limit is an eighth of this number."""

MOST_TERMS = 4096
"""Largest number of terms in the expanded sine or cosine of a sum of base angles; twelve angles give 2048."""


@dataclass
class Angles:
    """The angles in the formulas of a ring, whose sines and cosines :meth:`cosine_sine` returns.

    Attributes
    ----------
    ratios : Ratios
        The arithmetic of fractions in the ring.
    ratio : callable
        Reads an expression into the ring, as a fraction.
    forms : mapping
        Angle as it is written -> its linear form.
    bases : mapping
        Atom (a symbol, or a product such as ``x*y``, in angles) -> a coefficient c. The base angle is c times the atom,
        and the angles contain whole multiples of it: c = 1/2 for the angles theta and theta/2.
    cosines, sines : mapping
        Atom -> index of the variable for the cosine or sine of its base angle.
    fine, fine_place : int
        N, and the index of the ring's variable that stands for 2 cos(pi/N). The sines and cosines of constant angles
        that are no multiples of pi/24 are polynomials in this variable: N = 14 for 3 pi/7. N is 0 if the ring has no
        such variable.
    known : dict
        Angle -> (cosine, sine), the results of :meth:`cosine_sine` so far.
    """

    ratios: Ratios
    ratio: Callable[[Expr], Ratio]
    forms: Mapping[Expr, LinearForm]
    bases: Mapping[Expr, Fraction]
    cosines: Mapping[Expr, int]
    sines: Mapping[Expr, int]
    fine: int
    fine_place: int
    known: dict[Expr, tuple[Ratio, Ratio]] = field(default_factory=dict)

    def cosine_sine(self, argument: Expr) -> tuple[Ratio, Ratio]:
        """Return (cosine, sine) of an angle as fractions of polynomials in the cosines and sines of base angles.

        Raise TooLarge if the angle is too large a multiple of its base angle, or the expanded sine too long.
        """
        known = self.known.get(argument)
        if known is not None:
            return known
        form = self.forms[argument]
        cosine, sine = self.ratios.ring.one, self.ratios.ring.zero
        c0, s0 = map(self.ratio, constant_cosine_sine(form.half_turns))
        pairs = [(c0, s0)]
        for atom, coefficient in form.terms:
            if is_known_angle(atom, coefficient):
                pairs += self._known_angle(atom, coefficient)
                continue
            if atom is pi and self.fine:
                pairs.append(self._fine_constant(coefficient))
                continue
            multiple = int(coefficient / self.bases[atom])
            most = MOST_MULTIPLES // (1 + 7 * (atom is pi))
            if abs(multiple) > most:
                raise TooLarge(f"expected an angle of at most {most} times {self.bases[atom] * atom}, got {argument}")
            first, second = chebyshev(abs(multiple))
            c = univariate(self.ratios.ring, self.cosines[atom], first)
            s = univariate(self.ratios.ring, self.cosines[atom], second) * self.ratios.ring.gens[self.sines[atom]]
            s = s if multiple > 0 else -s
            if len(cosine) * (len(c) + len(s)) > MOST_TERMS:
                raise TooLarge(
                    f"the expanded sine of a sum of angles has more than {MOST_TERMS} terms; split the formula"
                )
            cosine, sine = cosine * c - sine * s, sine * c + cosine * s
        turned = Ratio(cosine), Ratio(sine)
        for pair in pairs:
            turned = self._turned(turned, pair)
        self.known[argument] = turned
        return turned

    def _turned(self, angle: tuple[Ratio, Ratio], by: tuple[Ratio, Ratio]) -> tuple[Ratio, Ratio]:
        """Return (cosine, sine) of the sum of two angles, each given as (cosine, sine)."""
        (cosine, sine), (c0, s0) = angle, by
        minus_s0 = self.ratios.multiply([self.ratios.number(-1), s0])
        turn, add = self.ratios.multiply, self.ratios.add
        return (
            add([turn([cosine, c0]), turn([sine, minus_s0])]),
            add([turn([sine, c0]), turn([cosine, s0])]),
        )

    def _known_angle(self, atom: Expr, coefficient: Fraction) -> Iterator[tuple[Ratio, Ratio]]:
        """Yield (cosine, sine) of angles that add up to ``coefficient * atom``; the atom is an inverse function.

        ``2*asin(u)`` gives the pair of asin(u) twice.
        """
        for halvings, times in halved(coefficient):
            c, s = map(self.ratio, cosine_sine(atom, halvings))
            if times < 0:
                s = self.ratios.multiply([self.ratios.number(-1), s])
            for _ in range(abs(times)):
                yield c, s

    def _fine_constant(self, half_turns: Fraction) -> tuple[Ratio, Ratio]:
        both = (cyclotomic.doubled_cosine(times, self.fine) for times in cyclotomic.multiples(half_turns, self.fine))
        cosine, sine = (Ratio(univariate(self.ratios.ring, self.fine_place, coefficients), 2) for coefficients in both)
        return cosine, sine
