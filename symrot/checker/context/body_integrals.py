"""Claims that give moments and products of inertia as integrals over a body: ``I_xy = integral of x y dm``.

The integrals of products of coordinates are independent; each entry of the inertia tensor is a sum of them. A product
of inertia is defined with or without the minus sign, and words may say which.
"""

import re
from collections.abc import Iterator, Sequence

from sympy import Expr, Poly, Symbol

from symrot.checker.claim.atoms import atoms_of
from symrot.checker.context.admission import plain
from symrot.checker.context.context import Context
from symrot.checker.context.substitution import Substitution
from symrot.exact.printing import as_text
from symrot.inertia.tensor import inertia_of_point
from symrot.symbols import position

__all__ = ["substitutions_of_integrals"]

INTEGRAL = re.compile(r"integral_[xyz]{2}")
ENTRY = re.compile(r"[IJP]_?([xyz1-3])([xyz1-3])?")
"""A moment or a product of inertia; its groups are the axes."""

AXES = {letter: axis for axis, letters in enumerate(("x1", "y2", "z3")) for letter in letters}
SIGNS = {"minus": 1, "plus": -1}


def substitutions_of_integrals(context: Context, sides: Sequence[Expr]) -> Iterator[Substitution]:
    """Yield the ways of reading a claim as one about entries of the inertia tensor and integrals over the body.

    There is none if the claim has another letter. Products of inertia have the minus sign in the first way, and none in
    the second, unless words say which sign they have.
    """
    names = {atom: plain(as_text(atom)) for atom in sorted(atoms_of(sides), key=str)}
    entries = {atom: match for atom, name in names.items() if (match := ENTRY.fullmatch(name))}
    if not entries or not any(map(INTEGRAL.fullmatch, names.values())):
        return
    if not all(atom in entries or INTEGRAL.fullmatch(name) for atom, name in names.items()):
        return
    places = {atom: (AXES[match[1]], AXES[match[2] or match[1]]) for atom, match in entries.items()}
    has_products = any(i != j for i, j in places.values())
    for sign in [context.sign_of_products] if context.sign_of_products else [*SIGNS] if has_products else ["minus"]:
        values = {atom: (1 if i == j else SIGNS[sign]) * _entry(i, j) for atom, (i, j) in places.items()}
        words = f", products of inertia with{'out' * (sign == 'plus')} the minus sign" if has_products else ""
        guess = "products of inertia without the minus sign" * (sign == "plus" and not context.sign_of_products)
        name = f"inertia tensor as an integral over the body{words}"
        yield Substitution(name, "symrot.inertia.tensor.inertia_of_point", values, guess)


def _entry(row: int, column: int) -> Expr:
    """Return an entry of the inertia tensor with a symbol for the integral of each product of two coordinates."""
    terms = Poly(inertia_of_point(1, position)[row][column], *position).terms()
    return sum(
        (factor * Symbol("integral_" + "".join(str(symbol) * power for symbol, power in zip(position, powers, strict=True)),
                         real=True) for powers, factor in terms),
        start=Poly(0, *position).as_expr(),
    )  # fmt: skip
