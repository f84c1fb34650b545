"""Proofs of a kernel's laws, such as "the norm is 1", from its formulas, as polynomial identities with cofactors.

A law states that expressions in inputs and outputs are zero. The outputs are replaced by their formulas. The result is
a fraction of polynomials over the inputs and over generators: variables for the cosine and sine of base angles (such as
x/2), for roots, signs and arc tangents. The proof writes its numerator as a sum of cofactors times relations, which are
the hypotheses of the law, ``s^2 + c^2 - 1`` for a base angle, ``r^2 - P`` for a root and ``g^2 - 1`` for a sign. Every
step from a function to its generator is recorded as an instance of a fact about functions (the tables FACTS and
RELATIONS of :mod:`symrot.certificates.exact_check`), so that a second program can follow the proof by multiplication.
Each branch of a conditional is a case of its own. A law holds where no denominator is zero.
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


@dataclass(frozen=True)
class LawProof:
    """A law of a kernel with its proof in every case; a case chooses one branch of each conditional.

    ``vanishing`` are the expressions that the law says are zero, as text. ``hypothesis_names`` are the symbols that the
    hypotheses of the law are about: components of a unit vector or unit quaternion, or the nine entries of a rotation
    matrix, row by row. ``witness`` is a point at which the hypotheses hold.
    """

    text: str
    vanishing: tuple[str, ...]
    hypothesis_names: tuple[str, ...]
    cases: tuple[CaseProof, ...]
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
    return LawProof(law.text, tuple(map(str, law.vanishing)), hypothesis_names, tuple(cases), witness)


ENTRIES = 9  # number of entries of a rotation matrix


def hypotheses(symbols: Sequence[Symbol]) -> tuple[Expr, ...]:
    """Return the expressions that are zero if the symbols form a unit vector, unit quaternion or rotation matrix.

    Nine symbols are a matrix, row by row; fewer are a vector or quaternion; without symbols the tuple is empty.
    """
    if len(symbols) == ENTRIES:
        return rotation_relations(Matrix(3, 3, symbols))
    return (sum(each**2 for each in symbols) - 1,) if symbols else ()


def _hypothesis_names(name: str, law: Law) -> tuple[str, ...]:
    """Return the names of the symbols in the hypotheses of a law, the relations that it presupposes.

    The hypotheses must say that the symbols form a unit vector, a unit quaternion or a rotation matrix; otherwise
    CertificateError is raised. ``name`` is the kernel, for its message.
    """
    symbols = sorted({symbol for relation in law.relations for symbol in relation.free_symbols}, key=str)
    if hypotheses(symbols) != law.relations:
        expected = "hypotheses that some numbers have squares that sum to one, or are the entries of a rotation"
        raise CertificateError(f"{name}: expected {expected}, for {law.text!r}, got other hypotheses")
    return tuple(map(str, symbols))


UNIT: dict[int, tuple[int, ...]] = {
    1: (1,),
    2: (4, 3),
    3: (6, 3, 2),
    4: (10, 4, 2, 1),
}  # integers whose squares sum to a square


def _witness(name: str, law: Law, hypothesis_names: Sequence[str], names: Sequence[str]) -> tuple[tuple[str, str], ...]:
    """Return a point at which the law's hypotheses hold, as pairs (input, exact number as text).

    A checker evaluates the proof there, to see that it hides no division by zero. ``names`` are all inputs, of which
    ``hypothesis_names`` occur in the hypotheses; ``name`` is the kernel, for messages.
    """
    point: dict[str, Expr] = {each: Rational(2 * k + 3, 7) for k, each in enumerate(names)}
    numbers = UNIT.get(4 if len(hypothesis_names) == ENTRIES else len(hypothesis_names), ())
    unit = tuple(Rational(each) / sqrt(sum(n * n for n in numbers)) for each in numbers)
    point |= zip(hypothesis_names, quaternion_to_dcm(unit) if len(hypothesis_names) == ENTRIES else unit, strict=True)
    if any(
        relation.subs({symbol: point[str(symbol)] for symbol in relation.free_symbols}) for relation in law.relations
    ):
        raise CertificateError(
            f"{name}: expected hypotheses of {law.text!r} that hold for some attitude, but they do not"
        )
    return tuple((each, str(point[each])) for each in names)


def _inputs(law: Law, formulas: Mapping[str, Expr]) -> list[str]:
    """Return the names of the free variables of a law, in a fixed order: pi, and the symbols that have no formula.

    ``formulas`` maps the name of a symbol to its formula.
    """
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
    """Return ``size`` names of generators in the order of the ring's variables: ``g2_``, ``g1_``, ``g0_`` for 3.

    A generator is a variable of the polynomial ring that stands for a function value, such as a root. A proof
    introduces ``g0_`` first, then ``g1_`` and so on. In the reversed order here, a later generator is a higher
    variable. For a root r = sqrt(P) with earlier generators in P, the leading term of ``r^2 - P`` is then ``r^2``, and
    division replaces r^2 by P.
    """
    return [f"g{k}_" for k in reversed(range(size))]
