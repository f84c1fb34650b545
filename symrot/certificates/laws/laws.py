"""Proofs of a kernel's laws, such as "the norm is 1", from its formulas, as polynomial identities.

A law states that expressions in inputs and outputs are zero. With generators (variables for function values such as
cos(x/2)), each expression becomes a fraction of polynomials. The proof writes the numerator as a sum of cofactors
times relations, which are polynomials known to be zero.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from sympy import Expr, Matrix, Rational, Symbol, sqrt
from sympy.polys.domains import QQ
from sympy.polys.orderings import lex
from sympy.polys.rings import PolyRing

from symrot.certificates.laws.law_proof import (
    BaseAngleTooLarge,
    CaseProof,
    Choice,
    LawProver,
    OutOfGenerators,
    UndecidedChoice,
)
from symrot.errors import CertificateError
from symrot.kernels.definition import Law
from symrot.kinematics.quaternion import quaternion_to_dcm, rotation_relations

__all__ = ["LawProof", "hypotheses", "prove_law"]

FEWEST = 8  # generators in the ring of the first attempt at a proof; a later attempt has twice as many


# Relations are the hypotheses of the law, s^2 + c^2 - 1 for a base angle, r^2 - P for a root and g^2 - 1 for a sign.
# Every step from a function to its generator is recorded as an instance of a fact (tables FACTS and RELATIONS of
# exact_check.py), so that a second program can follow the proof by multiplication.
@dataclass(frozen=True)
class LawProof:
    """A law of a kernel with its proof in every case; a case chooses one branch of each conditional."""

    text: str
    # the expressions that the law says are zero
    vanishing: tuple[str, ...]
    # components of a unit vector or unit quaternion, or the nine entries of a rotation matrix, row by row
    hypothesis_names: tuple[str, ...]
    cases: tuple[CaseProof, ...]
    # a point at which the hypotheses hold
    witness: tuple[tuple[str, str], ...]  # (input, number)


def prove_law(name: str, law: Law, formulas: Mapping[str, Expr]) -> LawProof:
    """Prove a law about quantities that have formulas, and return the proof.

    A symbol without a formula may take any value.

    Parameters
    ----------
    name : str
        The name of the kernel, for error messages.
    law : Law
        The law to prove.
    formulas : mapping of str to Expr
        A map from the name of a symbol to its formula.

    Returns
    -------
    LawProof
        The proof as text, with a case for each selection of branches of the conditionals in the formulas.

    Raises
    ------
    CertificateError
        If the law does not follow from the formulas.
    """
    names = _inputs(law, formulas)
    fewest, cases = FEWEST, []
    bases: dict[str, Fraction] = {}
    waiting: list[tuple[Choice, ...]] = [()]
    while waiting:
        decided = waiting.pop()
        try:
            cases.append(
                LawProver(name, law, formulas, PolyRing([*_pool(fewest), *names], QQ, lex), bases).run(decided)
            )
        except UndecidedChoice as choice:
            left, right = choice.args
            waiting += [(*decided, (left, relation, right)) for relation in ("<", ">=")]
        except BaseAngleTooLarge as angle:
            monomial, base = angle.args
            bases[monomial] = base
            waiting.append(decided)
        except OutOfGenerators:
            fewest *= 2
            waiting.append(decided)
    hypothesis_names = _hypothesis_names(name, law)
    witness = _witness(name, law, hypothesis_names, names[1:])
    # a law holds where no denominator is zero
    return LawProof(law.text, tuple(map(str, law.vanishing)), hypothesis_names, tuple(cases), witness)


ENTRIES = 9  # number of entries of a rotation matrix


def hypotheses(symbols: Sequence[Symbol]) -> tuple[Expr, ...]:
    """Return the expressions that are zero if the symbols form a unit vector, unit quaternion or rotation matrix.

    The result is empty if there are no symbols.
    """
    # nine symbols are a matrix, row by row
    if len(symbols) == ENTRIES:
        return rotation_relations(Matrix(3, 3, symbols))
    return (sum(each**2 for each in symbols) - 1,) if symbols else ()


def _hypothesis_names(name: str, law: Law) -> tuple[str, ...]:
    """Return the names of the symbols in a law's hypotheses, the relations that the law presupposes."""
    symbols = sorted({symbol for relation in law.relations for symbol in relation.free_symbols}, key=str)
    # only unit vectors, unit quaternions and rotation matrices are known
    if hypotheses(symbols) != law.relations:
        expected = "the hypotheses that squares of some symbols sum to one, or that they form a rotation matrix"
        raise CertificateError(f"{name}: expected {expected}, for {law.text!r}, got other hypotheses")
    return tuple(map(str, symbols))


UNIT: dict[int, tuple[int, ...]] = {
    1: (1,),
    2: (4, 3),
    3: (6, 3, 2),
    4: (10, 4, 2, 1),
}  # number of components -> integers whose squares sum to a square


def _witness(name: str, law: Law, hypothesis_names: Sequence[str], names: Sequence[str]) -> tuple[tuple[str, str], ...]:
    """Return a point at which a law's hypotheses hold, as pairs (name, exact number) for the inputs ``names``."""
    point: dict[str, Expr] = {each: Rational(2 * k + 3, 7) for k, each in enumerate(names)}
    numbers = UNIT.get(4 if len(hypothesis_names) == ENTRIES else len(hypothesis_names), ())
    unit = tuple(Rational(each) / sqrt(sum(n * n for n in numbers)) for each in numbers)
    point |= zip(hypothesis_names, quaternion_to_dcm(unit) if len(hypothesis_names) == ENTRIES else unit, strict=True)
    # a checker evaluates the proof at the point, to see that it hides no division by zero
    if any(
        relation.subs({symbol: point[str(symbol)] for symbol in relation.free_symbols}) for relation in law.relations
    ):
        raise CertificateError(
            f"{name}: expected hypotheses of {law.text!r} that hold at the point where symrot tests them (a unit "
            "vector, a unit quaternion or a rotation matrix), got hypotheses that do not hold there"
        )
    return tuple((each, str(point[each])) for each in names)


def _inputs(law: Law, formulas: Mapping[str, Expr]) -> list[str]:
    """Return the names of a law's free variables: pi, and the symbols that have no formula in ``formulas``."""
    inputs: set[str] = set()
    waiting, seen = [*law.vanishing, *law.relations], set()
    while waiting:
        for name in map(str, waiting.pop().free_symbols):
            if name not in seen:
                seen.add(name)
                waiting += [formulas[name]] if name in formulas else []
                inputs |= set() if name in formulas else {name}
    return ["pi", *sorted(inputs)]


def _pool(size: int) -> list[str]:
    """Return ``size`` names of generators in the order of the ring's variables: ``g2_``, ``g1_``, ``g0_`` for 3."""
    # A proof introduces g0_ first. A later generator is a higher variable: for a root r = sqrt(P) with earlier
    # generators in P, the leading term of r^2 - P is then r^2, and division replaces r^2 by P.
    return [f"g{k}_" for k in reversed(range(size))]
