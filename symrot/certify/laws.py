"""Prove the laws of a kernel from its formulas, as polynomial identities with cofactors that anyone can multiply out.

The outputs in a law are replaced by their formulas; what is left is a fraction of polynomials over the inputs and
generators: cosine and sine of base angles, roots, signs, arc tangents. Times its denominator it is a sum of cofactors
times relations: the hypotheses of the law, ``s^2 + c^2 - 1`` of a base angle, ``r^2 - P`` of a root, ``g^2 - 1`` of a
sign. How functions become generators is written down as steps, each an instance of a fact about functions (the tables
FACTS and RELATIONS of :mod:`symrot.certify.exact_check`), so that a second program can follow. Choices are followed
one branch at a time; a law holds where no denominator that occurs vanishes.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from sympy import Expr, Rational
from sympy.polys.domains import QQ
from sympy.polys.orderings import lex
from sympy.polys.rings import PolyRing

from symrot.certify.law_proof import Attempt, CaseProof, Choice, Coarse, Full, Undecided
from symrot.errors import CertificateError
from symrot.kernels.definition import Definition, Law
from symrot.kinematics.quaternion import dcm_of
from symrot.symbols import quaternion, rotation_entries

__all__ = ["LawProof", "prove_law", "prove_laws"]

FEWEST = 8  # generators of the first attempt at a proof


@dataclass(frozen=True)
class LawProof:
    """A law of a kernel, what vanishes and what is given as text, and its proof in every case of its choices."""

    text: str
    vanishing: tuple[str, ...]
    given: tuple[str, ...]
    cases: tuple[CaseProof, ...]
    witness: tuple[tuple[str, str], ...]  # input -> number: a point where all that is given holds


def prove_laws(found: Definition) -> tuple[LawProof, ...]:
    """Prove every law of a kernel, in every case of its choices.

    Raises
    ------
    CertificateError
        For a law that does not follow.
    """
    formulas = {str(symbol): value for symbol, value in found.named} | dict(found.formulas)
    return tuple(prove_law(found.name, law, formulas) for law in found.laws())


def prove_law(name: str, law: Law, formulas: Mapping[str, Expr]) -> LawProof:
    """Prove a law about quantities that have formulas, given by their names; others are free.

    Raises
    ------
    CertificateError
        If it does not follow.
    """
    names = _inputs(law, formulas)
    fewest, cases = FEWEST, []
    bases: dict[str, Fraction] = {}
    waiting: list[tuple[Choice, ...]] = [()]
    while waiting:
        decided = waiting.pop()
        try:
            cases.append(Attempt(name, law, formulas, PolyRing([*_pool(fewest), *names], QQ, lex), bases).run(decided))
        except Undecided as choice:
            left, right = choice.args
            waiting += [(*decided, (left, relation, right)) for relation in ("<", ">=")]
        except Coarse as angle:
            monomial, base = angle.args
            bases[monomial] = base
            waiting.append(decided)
        except Full:
            fewest *= 2
            waiting.append(decided)
    given = tuple(map(str, law.relations))
    return LawProof(law.text, tuple(map(str, law.vanishing)), given, tuple(cases), _witness(name, law, names[1:]))


ATTITUDE = tuple(Rational(n, 11) for n in (10, 4, 2, 1))  # a unit quaternion


def _witness(name: str, law: Law, names: Sequence[str]) -> tuple[tuple[str, str], ...]:
    """Return a point where what is given holds exactly: quaternions are of norm 1, matrices those of an attitude."""
    point: dict[str, Expr] = {each: Rational(2 * k + 3, 7) for k, each in enumerate(names)}
    point |= {str(symbol): value for symbol, value in zip(quaternion, ATTITUDE, strict=True)}
    point |= {str(symbol): value for symbol, value in zip(rotation_entries, dcm_of(ATTITUDE), strict=True)}
    if any(
        relation.subs({symbol: point[str(symbol)] for symbol in relation.free_symbols}) for relation in law.relations
    ):
        raise CertificateError(f"{name}: expected the hypotheses of {law.text!r} to hold for an attitude, they do not")
    return tuple((each, str(point[each])) for each in names)


def _inputs(law: Law, formulas: Mapping[str, Expr]) -> list[str]:
    """Return the names that are no formulas, in a fixed order."""
    found: set[str] = set()
    waiting, seen = [*law.vanishing, *law.relations], set()
    while waiting:
        for name in map(str, waiting.pop().free_symbols):
            if name not in seen:
                seen.add(name)
                waiting += [formulas[name]] if name in formulas else []
                found |= set() if name in formulas else {name}
    return ["pi", *sorted(found)]


def _pool(size: int) -> list[str]:
    """Return names of generators, later ones first: those that are made later lead."""
    return [f"g{k}_" for k in reversed(range(size))]
