"""Claims that give moments and products of inertia as integrals over a body: ``I_xy = integral of x y dm``.

The integrals are independent, and each entry of the inertia tensor is a sum of them. A product of inertia has the
minus sign or not, and words may say which.
"""

import re
from collections.abc import Iterator, Sequence
from typing import Any

from sympy import Add, Expr, ImmutableMatrix, Poly, Symbol

from symrot.checker.claim.interpreter import atoms_of
from symrot.checker.claim.scope import is_matrix
from symrot.checker.context.admission import plain
from symrot.checker.context.context import Context
from symrot.checker.context.relations.substitution import Substitution
from symrot.checker.verdict import Identification
from symrot.exact.decide import decide
from symrot.exact.printing import as_text
from symrot.inertia.tensor import inertia_of_point
from symrot.symbols import position

__all__ = ["TENSOR_OF_INTEGRALS", "is_tensor_of_integrals", "substitutions_of_gyration", "substitutions_of_integrals"]

INTEGRAL = re.compile(r"integral_[xyz]{2}")
ENTRY = re.compile(r"[IJP]_?([xyz1-3])([xyz1-3])?")
"""Pattern of the name of a moment or product of inertia, such as I_xy. Groups 1 and 2 are the axes; for I_x, group 2 is
None."""

TENSOR_OF_INTEGRALS = Identification(
    "inertia tensor as an integral over the body, products of inertia with the minus sign", "", {},
    "symrot.inertia.tensor.inertia_of_point",
)  # fmt: skip

AXES = {letter: axis for axis, letters in enumerate(("x1", "y2", "z3")) for letter in letters}
SIGNS = {"minus": 1, "plus": -1}


def substitutions_of_integrals(context: Context, sides: Sequence[Expr]) -> Iterator[Substitution]:
    """Yield each Substitution for a claim such as ``I_xy = integral of x y dm``: I_xy becomes an integral or its
    negative.
    """
    names = {atom: plain(as_text(atom)) for atom in sorted(atoms_of(sides), key=str)}
    entries = {atom: match for atom, name in names.items() if (match := ENTRY.fullmatch(name))}
    if not entries or not any(map(INTEGRAL.fullmatch, names.values())):
        return
    if not all(atom in entries or INTEGRAL.fullmatch(name) for atom, name in names.items()):
        return
    places = {atom: (AXES[match[1]], AXES[match[2] or match[1]]) for atom, match in entries.items()}
    has_products = any(i != j for i, j in places.values())
    # if nothing is stated, products of inertia with the minus sign are tried first
    for sign in [context.sign_of_products] if context.sign_of_products else [*SIGNS] if has_products else ["minus"]:
        values = {atom: (1 if i == j else SIGNS[sign]) * _entry(i, j) for atom, (i, j) in places.items()}
        words = f", products of inertia with{'out' * (sign == 'plus')} the minus sign" if has_products else ""
        guess = "products of inertia without the minus sign" * (sign == "plus" and not context.sign_of_products)
        name = f"inertia tensor as an integral over the body{words}"
        yield Substitution(name, "symrot.inertia.tensor.inertia_of_point", values, guess)


def is_tensor_of_integrals(sides: Sequence[Any]) -> bool:
    """Return whether a claim equates I or J, perhaps with a subscript, to the inertia tensor as a matrix of
    integrals.
    """
    matrices = [side for side in sides if is_matrix(side) and side.shape == (3, 3)]
    names = [side for side in sides if not is_matrix(side) and re.fullmatch("[IJ](_[A-Za-z])?", as_text(side))]
    if len(matrices) != 1 or len(names) != 1 or not matrices[0].atoms(Symbol):
        return False
    tensor = ImmutableMatrix(3, 3, _entry)
    return decide(tensor, matrices[0]).verdict == "true"


def _entry(row: int, column: int) -> Expr:
    """Return an entry of the inertia tensor as a sum of integrals over the body.

    For row 0 and column 0 the sum is ``integral_yy + integral_zz``, where the symbol integral_yy stands for the
    integral of y^2 dm.
    """
    terms = Poly(inertia_of_point(1, position)[row][column], *position).terms()
    return Add(*(factor * Symbol(f"integral_{_product(powers)}", real=True) for powers, factor in terms))


def _product(powers: Sequence[int]) -> str:
    """Return a product of coordinates as text: "xxy" for x^2 y, whose ``powers`` are (2, 1, 0)."""
    return "".join(str(symbol) * power for symbol, power in zip(position, powers, strict=True))


MOMENT_OF_AXIS, MASS, GYRATION = (
    re.compile(pattern) for pattern in (r"[IJ](_?\w+)?", "m|M", r"k(_?\w)?|r_?g|i|kappa|R_?g|rho")
)


def substitutions_of_gyration(context: Context, sides: Sequence[Expr]) -> Iterator[Substitution]:
    """Yield the Substitution of ``m k^2`` for the moment of inertia I, where k is the radius of gyration by definition.

    Only for a claim with exactly three letters: a moment of inertia, a mass and a radius of gyration.
    """
    names = {atom: plain(as_text(atom)) for atom in sorted(atoms_of(sides), key=str)}
    patterns = (MOMENT_OF_AXIS, MASS, GYRATION)
    if len(names) != len(patterns):
        return
    atoms_by_kind = [[atom for atom, name in names.items() if pattern.fullmatch(name)] for pattern in patterns]
    meanings = {atom: context.meaning_of(name) for atom, name in names.items()}
    radius_by_words = [
        atom for atom, meaning in meanings.items() if meaning and meaning.quantity.title == "radius of gyration"
    ]
    atoms_by_kind[2] = radius_by_words or atoms_by_kind[2]
    if [len(atoms) for atoms in atoms_by_kind] != [1, 1, 1]:
        return
    ((moment,), (mass,), (radius,)) = atoms_by_kind
    value = inertia_of_point(mass, (radius, 0, 0))[2][2]
    yield Substitution("moment of inertia from the radius of gyration", "derivations/parallel_axis.md", {moment: value})
