"""Prove the laws of a kernel from its formulas, as polynomial identities with cofactors that anyone can multiply out.

The outputs in a law are replaced by their formulas; what is left is a fraction of polynomials over the inputs and
generators: cosine and sine of base angles, roots, signs, arc tangents. Times its denominator it is a sum of cofactors
times relations: the hypotheses of the law, ``s^2 + c^2 - 1`` of a base angle, ``r^2 - P`` of a root, ``g^2 - 1`` of a
sign. How functions become generators is written down as steps, each an instance of a fact about functions (the tables
FACTS and RELATIONS of :mod:`symrot.certificates.exact_check`), so that a second program can follow. Choices are
followed one branch at a time; a law holds where no denominator that occurs vanishes.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from sympy import Expr, Matrix, Rational, Symbol, sqrt
from sympy.polys.domains import QQ
from sympy.polys.orderings import lex
from sympy.polys.rings import PolyRing

from symrot.certificates.laws.law_proof import Attempt, CaseProof, Choice, Coarse, Full, Undecided
from symrot.errors import CertificateError
from symrot.kernels.definition import Definition, Law
from symrot.kinematics.quaternion import quaternion_to_dcm, rotation_relations

__all__ = ["LawProof", "hypotheses", "prove_law", "prove_laws"]

FEWEST = 8  # generators of the first attempt at a proof


@dataclass(frozen=True)
class LawProof:
    """A law of a kernel, what vanishes as text, and its proof in every case of its choices.

    ``given`` are names of numbers whose squares sum to one, or of the nine entries of a rotation, row by row.
    """

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
    given = _given(name, law)
    witness = _witness(name, law, given, names[1:])
    return LawProof(law.text, tuple(map(str, law.vanishing)), given, tuple(cases), witness)


ENTRIES = 9  # of a rotation


def hypotheses(given: Sequence[Symbol]) -> tuple[Expr, ...]:
    """Return what vanishes for numbers whose squares sum to one, or for the nine entries of a rotation, row by row."""
    if len(given) == ENTRIES:
        return rotation_relations(Matrix(3, 3, given))
    return (sum(each**2 for each in given) - 1,) if given else ()


def _given(name: str, law: Law) -> tuple[str, ...]:
    """Return the names that the hypotheses of a law are about."""
    given = sorted({symbol for relation in law.relations for symbol in relation.free_symbols}, key=str)
    if hypotheses(given) != law.relations:
        expected = "numbers whose squares sum to one, or a rotation, as what is given"
        raise CertificateError(f"{name}: expected {expected} for {law.text!r}")
    return tuple(map(str, given))


UNIT: dict[int, tuple[int, ...]] = {1: (1,), 2: (4, 3), 3: (6, 3, 2), 4: (10, 4, 2, 1)}  # their squares sum to a square


def _witness(name: str, law: Law, given: Sequence[str], names: Sequence[str]) -> tuple[tuple[str, str], ...]:
    """Return a point where what is given holds exactly: quaternions are of norm 1, matrices those of an attitude."""
    point: dict[str, Expr] = {each: Rational(2 * k + 3, 7) for k, each in enumerate(names)}
    numbers = UNIT.get(4 if len(given) == ENTRIES else len(given), ())
    unit = tuple(Rational(each) / sqrt(sum(n * n for n in numbers)) for each in numbers)
    point |= zip(given, quaternion_to_dcm(unit) if len(given) == ENTRIES else unit, strict=True)
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
