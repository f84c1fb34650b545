"""The letters (symbols, rates and angles) of a claim's formula, with random values at the test points.

The search for a fault in the formula uses them. The values obey the equations among the claim's hypotheses. A name
with a definition, such as c1 for cos(alpha), has the definition's value.
"""

from collections.abc import Mapping
from dataclasses import replace

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.tree import TIME, Node, is_derivative, walk
from symrot.checker.recognition.single_faults.parts import Letters, PointOfLetters, Values, rates_of_entries, values_of
from symrot.checker.repair.edits.names import OPPOSITE
from symrot.checker.repair.filter import NumericFilter
from symrot.checker.repair.points import points
from symrot.checker.repair.rows import is_matrix

__all__ = ["POINTS", "ids_of_nodes", "is_atom", "letters_of_formula", "nodes_of", "text_of"]

MOST_DRAWS = 40
"""The largest number of random points that are drawn to find ``POINTS`` of them where a formula has a value."""
MOST_DRAWS_WITH_ROOTS = 400
"""The number of random points that are drawn for a claim's formula with roots.

The points with the largest values under the roots are used: a known formula that differs from the claim's formula by
one fault, and so has other values under its roots, is likely to be defined at these points too.
"""
POINTS = 3
"""The number of points at which formulas are compared."""
MANY = 9
"""From this number of letters on, a formula is tested for letters on which its value does not depend.

A formula with a matrix of 3 x 3 letters may depend only on some of the letters: the trace depends on three.
"""


def letters_of_formula(claim: Claim, named: NamedFormula) -> Letters | None:
    """Return the letters of a claim's formula, with random values that obey the equations among its hypotheses.

    Return None if fewer than POINTS of the random points give the formula a value, or if a letter is a matrix or has no
    value at these points.
    """
    numeric = NumericFilter(claim)
    short = claim.defining  # such as c1 = cos(alpha)
    defined_names = {**numeric.definitions, **short}
    hypotheses = [
        relation[1:]
        for relation in claim.hypotheses
        if relation[0] == "==" and short.get(str(relation[1].value)) != relation[2]
    ]
    free = sorted({*numeric.symbols, *_symbols_of(short, numeric)} - {*short})
    narrow = any(node.value in ("asin", "acos", "cos") for node in (named.side, *nodes_of(named.formula)))
    roots = [node.args[0] for node in nodes_of(named.formula) if node.kind == "call" and node.value == "sqrt"]
    drawn = points(
        free, numeric.functions, defined_names, hypotheses, frozenset(),
        count=POINTS if hypotheses else MOST_DRAWS_WITH_ROOTS if roots else MOST_DRAWS, most=0.9 if narrow else 1.7,
    )  # fmt: skip
    defined = [point for point in drawn if values_of(named.formula, [point]) is not None]
    at = sorted(defined, key=lambda point: -min((point.value(root) for root in roots), default=0.0))[:POINTS]
    if len(at) < POINTS:
        return None
    # in I_1*omega_1' = .. the factor I_1 is a letter of the formula for omega_1', too
    factors = named.side.args if named.side.kind == "product" else ()
    coefficients = [factor for factor in factors if factor.kind == "name" and factor.value != named.name]
    trees, atoms, angles = [named.formula, *coefficients], dict[Node, Values](), dict[Node, Values]()
    while trees:
        tree = trees.pop()
        if tree.kind == "call" and tree.value in OPPOSITE:
            angles[tree.args[0]] = values_of(tree.args[0], at) or ()
        if is_derivative(tree) and str(tree.args[0].value) in defined_names:
            trees.append(rates_of_entries(defined_names[str(tree.args[0].value)], tree.args[1:]))
        elif is_atom(tree):
            if tree.kind == "name" and tree.value in defined_names:
                trees.append(defined_names[str(tree.value)])
            elif tree.value != "pi":
                atoms[tree] = values_of(tree, at) or ()
        else:
            trees.extend(tree.args)
    if not all(map(len, (*atoms.values(), *angles.values()))) or any(is_matrix(v[0]) for v in atoms.values()):
        return None
    places = [
        PointOfLetters(
            dict(point.symbols), {}, defined_names, ids_of_nodes(named.formula),
            rates={atom: values[place] for atom, values in atoms.items() if atom.kind == "call"},
        )
        for place, point in enumerate(at)
    ]  # fmt: skip
    aliases = {Node("name", name): values_of(Node("name", name), at) or () for name in short}
    return Letters(_active(named, atoms, places), angles, places, aliases)


def _symbols_of(definitions: Mapping[str, Node], numeric: NumericFilter) -> set[str]:
    """Return the symbols in the formulas of ``definitions``: {"alpha"} for ``{"c1": cos(alpha)}``."""
    # without names of functions of time and names with a definition of their own
    names = {str(node.value) for tree in definitions.values() for _, node in walk(tree) if node.kind == "name"}
    return names - {"pi", *numeric.functions, *numeric.definitions}


def _active(named: NamedFormula, atoms: dict[Node, Values], places: list[PointOfLetters]) -> dict[Node, Values]:
    """Return the letters among ``atoms`` whose change by 0.1 changes the value of the claim's formula.

    Of the 9 entries of a matrix in a trace, these are the 3 on the diagonal. Letters that are factors or arguments of
    the claim's left side are returned too. If there are fewer than MANY ``atoms``, all are returned without a test.
    """
    formula = named.formula
    if len(atoms) < MANY:
        return atoms  # a formula of few letters depends on all of them
    here = values_of(formula, places[:1])
    active = {}
    for atom, values in atoms.items():
        moved = replace(places[0], known={}, remembered=frozenset())
        if atom.kind == "name":
            moved.symbols = {**moved.symbols, str(atom.value): values[0] + 0.1}
        else:
            moved.rates = {**moved.rates, atom: values[0] + 0.1}
        if values_of(formula, [moved]) != here or atom in named.side.args:
            active[atom] = values
    return active


def ids_of_nodes(tree: Node) -> frozenset[int]:
    """Return the ``id`` of every node in a tree."""
    # a test point remembers the values of the nodes with these ids
    return frozenset(id(node) for _, node in walk(tree))


def nodes_of(tree: Node) -> list[Node]:
    """Return all nodes of a tree, parents before children."""
    return [node for _, node in walk(tree)]


def is_atom(tree: Node) -> bool:
    """Return whether a tree is a name, a function of time such as ``phi(t)``, or a time derivative of a function."""
    if tree.kind == "name":
        return True
    inner = tree
    while is_derivative(inner) and set(inner.args[1:]) == {TIME}:
        inner = inner.args[0]
    return inner.kind == "call" and inner.args == (TIME,) and tree.kind == "call"


def text_of(atom: Node) -> str:
    """Return the text of a symbol or rate, such as "phi(t)" or "diff(phi(t), t)"."""
    if atom.kind == "name":
        return str(atom.value)
    return f"diff({text_of(atom.args[0])}, {', '.join('t' for _ in atom.args[1:])})" if atom.value == "diff" else (
        f"{atom.value}(t)"
    )  # fmt: skip
