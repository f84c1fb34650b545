"""The correction of a claim's matrix, derived from the rest of the claim: the only matrix that makes it true."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from functools import reduce
from math import gcd, lcm
from typing import Any

from sympy import Derivative, Dummy, Expr, ImmutableMatrix, Matrix, MatrixBase, Rational, Symbol, cos, cot, csc, sin

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.tree import Node, number, product, replaced, walk
from symrot.checker.repair.filter import matrix_entries
from symrot.checker.typed.readings import Declared
from symrot.exact.decide import normal_form
from symrot.exact.decision import flatten
from symrot.exact.printing import as_text

__all__ = ["derived_part"]

EVALUATED = ("diff", "integrate")
"""Functions that a derived formula must not contain: it should show their result, such as 2*x for diff(x^2, x)."""


def derived_part(claim: Claim, place: str) -> Node | None:
    """Return the formula that the claim must have at ``place``, "left" or the name of a definition, to be true.

    Return None if the claim does not determine it.

    Examples
    --------
    >>> from symrot.checker.claim.claims import Claim
    >>> from symrot.checker.claim.reader import read_relation
    >>> from symrot.checker.claim.tree import text
    >>> relation = read_relation("diag(0, 2*m*r**2) == Matrix([[m*r**2/3, 0], [0, m*r**2]])")
    >>> text(derived_part(Claim(relation=relation, implied=True), "left"))
    'diag(m*r**2/3, m*r**2)'
    """
    assert claim.relation is not None
    _, left, right = claim.relation
    if place != "left":
        return _solved(claim, place)
    factors = left.args if left.kind == "product" else (left,)
    matrices = [factor for factor in factors if matrix_entries(factor)]
    if len(matrices) == 1:
        return _scaled(claim, factors, matrices[0])
    # any other left side becomes the right side, if that has no derivatives and integrals
    calls = {node.value for _, node in walk(right) if node.kind == "call"}
    return None if calls & {*EVALUATED} else right


def _scaled(claim: Claim, factors: Sequence[Node], matrix: Node) -> Node | None:
    """Return the product of ``factors``, the left side of the claim, changed so that it equals the right side.

    The factor ``matrix`` gets new entries; a number among the factors may change too. Return None if ``matrix`` and
    the right side differ in shape, or if ``matrix`` is written with ``diag`` and an entry off the diagonal would not be
    zero.
    """
    values, shape = flatten(claim.equation.right)
    if shape != flatten(claim.interpreter().read(matrix))[1]:
        return None
    numbers = [factor for factor in factors if not any(node.kind in ("name", "call") for _, node in walk(factor))]
    scalars = [factor for factor in factors if factor is not matrix and factor not in numbers]
    scale = claim.interpreter().read(product(scalars)) if scalars else Rational(1)
    entries = [normal_form(value / scale) for value in values]
    # a number among the factors changes, so that the entries have integers without a common divisor
    ratio = _largest_factor(entries) if numbers else Rational(1)
    made = _with_entries(claim, matrix, [entry / ratio for entry in entries])
    if made is None:
        return None
    above = [number(int(ratio.p))] if ratio.p != 1 else []
    below = [Node("inv", None, (number(int(ratio.q)),))] if ratio.q != 1 else []
    return product([*above, *scalars, *below, made])


def _largest_factor(entries: Sequence[Expr]) -> Any:
    """Return the greatest common divisor of the coefficients of all entries: 2/3 for ``2*a/3`` and ``4*b``.

    Return 1 if a coefficient is irrational, or if all entries are zero.
    """
    numbers = [entry.as_coeff_Mul()[0] for entry in entries if entry != 0]
    if not numbers or not all(value.is_Rational for value in numbers):
        return Rational(1)
    return Rational(reduce(gcd, (abs(value.p) for value in numbers)), reduce(lcm, (value.q for value in numbers)))


def _with_entries(claim: Claim, matrix: Node, entries: Sequence[Expr]) -> Node | None:
    """Return the written-out ``matrix`` with the given entries, row by row.

    Return None if ``matrix`` is written with ``diag`` and an entry off the diagonal is not zero.
    """
    cells = matrix_entries(matrix)
    if any(entry != 0 and place not in cells for place, entry in enumerate(entries)):
        return None
    names = Declared({*claim.symbols, *(name for name, _ in claim.define)}, claim.functions)
    calls = {node.value for _, node in walk(matrix) if node.kind == "call"}
    for place, path in cells.items():
        entry = _with_cosecants(entries[place]) if calls & {"cot", "csc"} else entries[place]
        made = _with_rates_first(read_expression(as_text(entry), "", names))
        matrix = replaced(matrix, path, made)
    return matrix


def _with_rates_first(tree: Node) -> Node:
    """Return a formula with the factors of each product in the order of books: numbers and letters, then derivatives,
    then other functions, such as sines.
    """
    args = list(map(_with_rates_first, tree.args))
    if tree.kind == "product":
        args.sort(key=lambda factor: (factor.kind == "call") + (factor.kind == "call" and factor.value != "diff"))
    return replace(tree, args=tuple(args))


def _with_cosecants(entry: Expr) -> Expr:
    """Return a product with cot x in place of cos x/sin x, and csc x in place of 1/sin x."""
    powers = entry.as_powers_dict()
    for base in [base for base, exponent in powers.items() if isinstance(base, sin) and exponent == -1]:
        x = base.args[0]
        entry = entry * base * (cot(x) / cos(x) if powers.get(cos(x), 0) == 1 else csc(x))
    return entry


# -- a matrix that is a definition of the claim ------------------------------------------------------------------------


def _solved(claim: Claim, name: str) -> Node | None:
    """Return the matrix ``name``, a definition of the claim, with the entries that make the claim true.

    Return None if the claim does not determine the entries.
    """
    assert claim.relation is not None
    tree = dict(claim.define)[name]
    value = claim.interpreter().read(tree)
    if not isinstance(value, MatrixBase) or not matrix_entries(tree):
        return None
    unknown = [Dummy(f"{name}{place}", real=True) for place in range(len(value))]
    interpreter = claim.interpreter()
    interpreter.values[name] = ImmutableMatrix(*value.shape, unknown)
    left, right = (flatten(interpreter.read(side))[0] for side in claim.relation[1:])
    # linear equations for the entries, which must hold for all rates in the claim
    equations = list(_coefficients_of_rates([a - b for a, b in zip(left, right, strict=True)]))
    solution: dict[Symbol, Expr] = {}
    for system in _independent_systems(equations, unknown):
        entries = sorted(set().union(*(equation.free_symbols for equation in system)).intersection(unknown), key=str)
        if len(system) != len(entries):
            return None
        matrix = Matrix([[equation.coeff(entry) for entry in entries] for equation in system])
        constants = Matrix([-equation.xreplace(dict.fromkeys(entries, Rational(0))) for equation in system])
        determinant = normal_form(matrix.det())
        if determinant == 0:
            return None
        solution |= zip(entries, map(normal_form, matrix.adjugate() * constants / determinant), strict=True)
    if solution.keys() != {*unknown}:
        return None
    return _with_entries(claim, tree, [solution[entry] for entry in unknown])


def _independent_systems(equations: Sequence[Expr], unknown: Collection[Symbol]) -> list[list[Expr]]:
    """Return the equations in groups that have no unknown in common."""
    groups: list[tuple[set[Any], list[Expr]]] = []
    for equation in equations:
        names, system = equation.free_symbols.intersection(unknown), [equation]
        for group in [group for group in groups if group[0] & names]:
            groups.remove(group)
            names, system = names | group[0], [*group[1], *system]
        groups.append((names, system))
    return [system for _, system in groups]


def _coefficients_of_rates(differences: Sequence[Expr]) -> Iterator[Expr]:
    """Yield the coefficients of each rate, and the rest, of formulas that are linear in the rates; each must vanish."""
    for difference in differences:
        expanded = difference.doit().expand()
        rates = sorted(expanded.atoms(Derivative), key=str)
        yield from (expanded.coeff(rate) for rate in rates)
        rest = expanded.xreplace(dict.fromkeys(rates, Rational(0)))
        if rest != 0:
            yield rest
