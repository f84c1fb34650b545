"""Claims such as ``k^2 = I/m`` that give a formula for a quantity which the claim itself does not define.

Such a claim is not an identity: whether it holds depends on what its letters mean.
"""

from collections.abc import Collection, Iterator, Sequence
from typing import NamedTuple

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.interpreter import atoms_of
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.solving import (
    Solve,
    quantities_in,
    solution,
    terms_of,
    with_highest_rate,
    without_common_factors,
)
from symrot.checker.claim.tree import (
    Node,
    is_derivative,
    is_name,
    is_rate,
    negated,
    nodes_of,
    number,
    quotient,
    sum_of,
    text,
    without_sign,
)
from symrot.checker.claim.vectors import is_components
from symrot.errors import InputError
from symrot.exact import normal_form
from symrot.exact.decision import flatten
from symrot.exact.ring.ratio import TooLarge

__all__ = [
    "NamedFormula", "claims_identity", "named_formula", "open_formula", "related_formula",
]  # fmt: skip

MARKED = ("_prime", "_dot", "_star")
"""Endings of the names for ``theta'`` and ``z*``: such quantities depend on theta and z."""


class NamedFormula(NamedTuple):
    """A claim such as ``k^2 = I/m``, split into a quantity that it does not define (k) and a formula for it.

    Attributes
    ----------
    name : str
        The quantity, k; the text of ``side`` if the claim is not solved for one quantity.
    side, formula : Node
        The side of the claim with the quantity, ``k^2``, and the other side, ``I/m``.
    is_rate : bool
        Whether the claim gives the time derivative of the quantity.
    solve : function or None
        Turns a formula for ``side`` into one for the quantity: I/m into sqrt(I/m). None if the claim is not solved.
    """

    name: str
    side: Node
    formula: Node
    is_rate: bool = False
    solve: Solve | None = lambda formula: formula


def named_formula(claim: Claim) -> NamedFormula | None:
    """Return the name and the formula of a quantity for a claim such as ``T = m v^2/2``; None for other claims.

    None also if the quantity is pi, the time t, or a name that has a formula in ``claim.define``.
    """
    assert claim.relation is not None
    _, left, right = claim.relation
    if claim.has_double_equals and _compares_rates(left, right):
        return None
    others = [side for relation in claim.hypotheses for side in relation[1:]] + [tree for _, tree in claim.define]
    known, defined = _known(claim), dict(claim.define)
    # the quantity may be a symbol, a function of time or its derivative, and must occur nowhere else
    for side, formula in ((left, right), (right, left)):
        inner = side.args[0] if is_rate(side) else side
        is_wrong_shape = inner.value in defined and formula.kind == "number" and formula.value
        is_bare = is_name(formula) and not str(inner.value).endswith(MARKED)
        if is_name(inner) and inner.value not in known and not is_bare and not is_wrong_shape:
            elsewhere = nodes_of(formula, *others)
            if side not in elsewhere and not (inner is side and inner.value in [n.value for n in elsewhere]):
                return NamedFormula(str(inner.value), side, formula, is_rate(side))
    return None


def open_formula(claim: Claim) -> NamedFormula | None:
    """Return the NamedFormula of an equation for an unknown function L, such as ``diff(L, q) == 0``.

    The equation is not solved for L: the NamedFormula has the left side and the right side as they are, and ``solve``
    is None. Return None for other claims.
    """
    assert claim.relation is not None
    _, left, right = claim.relation
    if not claim.implied or claim.hypotheses:
        return None
    known = {"pi", "t", *dict(claim.define)}
    # it fails for most functions L: it restricts L and is no identity, so its sides must not be compared
    for side in (left, right):
        for node in nodes_of(side):
            if is_derivative(node):
                names, others = ({*_letters_of(part)} for part in (node.args[:1], node.args[1:]))
                if names and not names & {*known, *others} and not _depends_on_time(node):
                    return NamedFormula(text(left), left, right, solve=None)
    return None


def _is_open_rate(side: Node, other: Node) -> bool:
    """Return whether ``side`` has a time derivative whose value only a law of motion can give.

    ``other`` is the other side of the equation. An example is ``(I w)'`` in the equation ``(I w)' = 0``.
    """
    derivatives = (node for node in nodes_of(side) if is_derivative(node))
    has_rate = any(not is_name(node.args[0]) and {v.value for v in node.args[1:]} == {"t"} for node in derivatives)
    others = {*_letters_of([other])}
    if any(is_derivative(node) for node in nodes_of(other)):
        return False  # both sides are derivatives: nothing is given by a letter
    # C w_3' = 0
    if other == number(0) and side.kind == "product" and any(map(is_rate, side.args)):
        return True
    # in (I w^2/2)' = I w alpha, the letter alpha does not follow from the derivative
    return has_rate and (other == number(0) or bool(others - {*_letters_of([side])} - {"pi", "t"}))


def _letters_of(trees: Sequence[Node]) -> Iterator[str]:
    """Yield the names of the symbols and of the functions of time in several trees."""
    for tree in trees:
        yield from (str(node.value) for node in nodes_of(tree) if node.kind == "name" or is_name(node))


def _depends_on_time(derivative: Node) -> bool:
    """Return whether a derivative is with respect to time and contains a function of time: ``diff(x(t)**2, t)``."""
    inner, *variables = derivative.args
    return any(v.value == "t" for v in variables) and any(
        node.kind == "call" and node.value != "diff" and is_name(node) for node in nodes_of(inner)
    )


def related_formula(claim: Claim) -> NamedFormula | None:
    """Return the NamedFormula of an equation such as ``k^2 = I/m``, true only if its letters mean certain quantities.

    Return None for other claims, which are meant as identities.
    """
    assert claim.relation is not None
    left, right = without_common_factors(*claim.relation[1:])
    known = _known(claim)
    letters = [quantities_in(side) for side in (left, right)]
    generic = {name for name, tree in claim.define if is_components(name, tree)}
    is_condition = _is_condition_on_vectors(left, right, bool(claim.hypotheses))
    is_condition = is_condition or _is_condition_on_matrix(left, right, generic)
    is_condition = is_condition or (not claim.hypotheses and _is_equation_of_matrix(claim, left, right, generic))
    if is_condition or _has_own_angle(left, right, generic) or _has_open_derivative(left, right, known):
        return NamedFormula(text(left), left, right, solve=None)
    always = {"pi", "t"} - {*dict(claim.define)}  # t = tan(theta/2) is no time
    defined = {name for quantities in letters for name, _ in quantities} & (known - always)
    is_open_rate = _is_open_rate(left, right) or _is_open_rate(right, left)
    if not claim.hypotheses and not defined and is_open_rate and not _has_hidden_zero(claim, left, right):
        return NamedFormula(text(left), left, right, solve=None)
    is_moving = any(is_derivative(node) for node in nodes_of(left, right))
    if not claim.hypotheses and left.kind == "name" and _has_own_letters(_letters_by_definition(claim, left, right)):
        return NamedFormula(text(left), left, right, solve=None)
    if claim.hypotheses or any(
        name in known and (name != "t" or is_moving or name not in always)
        for quantities in letters
        for name, _ in quantities
    ):
        return None
    if all(is_name(side) or is_rate(side) for side in (left, right)):
        return None
    apart = all(letters) and not letters[0] & letters[1] and _says_something(claim, left, right)
    if any(is_matrix(side) and side.shape != (1, 1) for side in (claim.equation.left, claim.equation.right)):
        if (solved := _solved_for_vector(claim, left, right)) is not None:
            return solved
        if _equation_of_motion(left, right) is not None:
            return NamedFormula(text(left), left, right, solve=None)
        for side, formula in ((left, right), (right, left)):
            if apart and _is_list_of_names(side):
                return NamedFormula(text(side), side, formula)
        return None
    if apart:
        for side, formula in ((left, right), (right, left)):
            if (inverted := solution(side)) is not None:
                (name, of_rate), solve = inverted
                # k^2 = I/m gives k
                return NamedFormula(name, side, formula, of_rate, solve)
        return NamedFormula(text(left), left, right, solve=None)
    if (equation := _equation_of_motion(left, right)) is not None:
        return equation
    is_whole = (left, right) == claim.relation[1:]  # no common factor was left out
    is_open = (is_whole and _is_constraint(left, right, letters)) or (
        _has_own_letters(letters) and _depends_on_own_letters(claim)
    )
    # m*a = m*g - T relates several quantities: its sides stand for a quantity and its formula
    return NamedFormula(text(left), left, right, solve=None) if is_open else None


def claims_identity(claim: Claim) -> bool:
    """Return whether a claim says that both sides are equal for all values of its letters, as ``m*a == k*x`` does.

    ``m*a = k*x``, with one ``=``, is not such a claim: it is a relation between four quantities.
    """
    if claim.relation is None or not claim.has_double_equals:
        return False
    sides = claim.relation[1:]
    if _compares_rates(*sides):
        return True
    for side, other in (sides, sides[::-1]):
        own = quantities_in(side)
        # 2*k**2 and cos(theta) name k and theta; m*a names nothing
        if len(own) == 1 and not own & quantities_in(other) and solution(side) is not None:
            return False
        if _is_list_of_names(side):
            return False
        if other == number(0) and _is_open_rate(side, other):
            return False  # diff(x**2, t) == 0 says that x is constant
    nodes = nodes_of(*sides)
    # diff(H, t) is the rate of an unknown quantity H
    if any(is_derivative(node) and node.args[0].kind == "name" for node in nodes):
        return False
    motion = with_highest_rate(*sides)
    return motion is None or any(node.kind == "call" for node in nodes_of(motion[1]))


def _compares_rates(left: Node, right: Node) -> bool:
    """Return whether an equation has the time derivatives of a letter and of a formula with this letter.

    An example is ``diff(2*x, t) == diff(x, t)``.
    """
    derivatives = [node for node in nodes_of(left, right) if is_derivative(node)]
    arguments = [node.args[0] for node in derivatives if all(each.value == "t" for each in node.args[1:])]
    quantities = {each.value for each in arguments if each.kind == "name"}
    return any(node.value in quantities for each in arguments if each.kind != "name" for node in nodes_of(each))


def _has_hidden_zero(claim: Claim, left: Node, right: Node) -> bool:
    """Return whether a side of an equation is zero but not written as 0, such as ``2*y - y - y``."""
    # diff(x**2, t) == 0 states that x is constant; with a hidden zero it is meant as an identity
    try:
        sides = [claim.interpreter().read(side) for side in (left, right) if side != number(0)]
        return any(not is_matrix(value) and normal_form(value) == 0 for value in sides)
    except (InputError, TooLarge):
        return False


def _says_something(claim: Claim, left: Node, right: Node) -> bool:
    """Return whether both sides depend on letters, unlike those of ``z/z == 1``, and are not just two letters, as in
    ``x = y``.
    """
    try:
        values = [claim.interpreter().read(side) for side in (left, right)]
        forms = [value if is_matrix(value) else normal_form(value) for value in values]
    except (InputError, TooLarge):
        return True
    # x = y relates two single letters, which is no formula
    return all(form.free_symbols for form in forms) and not all(form.is_Symbol for form in forms)


def _solved_for_vector(claim: Claim, left: Node, right: Node) -> NamedFormula | None:
    """Solve an equation for one of its vectors: ``v - u = w x r`` gives v and the formula ``u + w x r``.

    The vector has no definition, is a whole term, and occurs once in the equation. Return None if there is none.
    """
    terms = [*terms_of(left), *map(negated, terms_of(right))]
    generic = {name for name, tree in claim.define if is_components(name, tree)}
    everywhere = [node.value for node in nodes_of(*terms) if node.kind == "name"]
    for term in terms:
        bare = without_sign(term)
        if bare.kind == "name" and bare.value in generic and everywhere.count(bare.value) == 1:
            rest = sum_of([other for other in terms if other is not term])
            return NamedFormula(str(bare.value), bare, rest if term.kind == "neg" else negated(rest))
    return None


def _is_constraint(left: Node, right: Node, letters: Sequence[set[tuple[str, bool]]]) -> bool:
    """Return whether an equation restricts letters by a number, as ``x^2 + y^2 = 1`` and ``T/U = 2`` do."""
    polynomial, constant = (left, right) if letters[0] else (right, left)
    if polynomial.kind == "product" and not quantities_in(constant) and constant != number(0):
        factors = [factor.args[0] if factor.kind == "inv" else factor for factor in polynomial.args]
        names = [str(factor.value) for factor in factors if is_name(factor)]
        return len({*names}) > 1 and all(factor.kind == "number" or is_name(factor) for factor in factors)
    if polynomial.kind != "sum" or constant.kind != "number":
        return False
    powers = [node for node in nodes_of(polynomial) if node.kind == "power"]
    outside = {name for factor in _factors(polynomial) if is_name(factor) for name, _ in quantities_in(factor)}
    return len(outside) > 1 and all(power.args[1].kind == "number" for power in powers)


def _letters_by_definition(claim: Claim, left: Node, right: Node) -> list[set[tuple[str, bool]]]:
    """Return the sets of quantities of both sides after definitions are inserted.

    For ``F == k*x`` with the definition ``F = m*a``, the sets have m and a for the left side, k and x for the right
    side. A quantity is a pair (name, whether its rate is meant). Both sets are empty if the left side is not a defined
    name.
    """
    defined = {name: tree for name, tree in claim.define if not is_components(name, tree)}
    if left.value not in defined:
        return [set(), set()]
    sides = []
    for side in (left, right):
        letters, open_names = set[tuple[str, bool]](), quantities_in(side)
        for _ in range(len(defined) + 1):
            inner = {name for name, _ in open_names if name in defined}
            letters |= {quantity for quantity in open_names if quantity[0] not in inner and quantity[0] != "t"}
            open_names = {quantity for name in inner for quantity in quantities_in(defined[name])}
        sides.append(letters)
    return sides


def _has_own_letters(letters: Sequence[set[tuple[str, bool]]]) -> bool:
    """Return whether each side of an equation has a quantity that the other side lacks, as in ``m*a == m*g - T``."""
    left, right = letters
    # such an equation determines its quantities; nobody means it as an identity
    return bool(left - right) and bool(right - left)


def _depends_on_own_letters(claim: Claim) -> bool:
    """Return whether each side depends on a letter that the other side lacks, as in ``m*a == k*x``.

    The exception is a pair of sides that become equal if one letter is replaced, as ``x*cos(a) == x*cos(b)`` with a for
    b: False, because one of the letters is probably a misprint.
    """
    try:
        sides = [list(map(normal_form, flatten(side)[0])) for side in (claim.equation.left, claim.equation.right)]
        left, right = map(atoms_of, sides)
        own = [*(left - right), *(right - left)]
        if len(own) == 2 and all(atom.is_Symbol for atom in own) and left - right and right - left:
            other = dict([own])
            # sides that agree with b for a have a mistyped letter: x*cos(a) == x*cos(b) is a false identity
            changed = [form.xreplace(other) for form in sides[0]]
            return any(normal_form(a - b) != 0 for a, b in zip(changed, sides[1], strict=True))
    except TooLarge:
        left, right = (atoms_of(flatten(side)[0]) for side in (claim.equation.left, claim.equation.right))
    return bool(left - right) and bool(right - left)


def _is_condition_on_vectors(left: Node, right: Node, has_hypotheses: bool) -> bool:
    """Return whether an equation sets a product of vectors or a length to a number, as ``a . b = 0`` does.

    If ``has_hypotheses``, a length does not count: a hypothesis of the claim may say that it is 1.
    """
    for side, other in ((left, right), (right, left)):
        product_of = side.args[0] if side.kind == "call" and side.value == "sqrt" else side
        if other.kind == "number" and product_of.kind == "call" and product_of.value in ("dot", "cross"):
            first, second = product_of.args
            # the length of a unit vector is not a condition
            return not (has_hypotheses and first == second)
    return False


def _is_condition_on_matrix(left: Node, right: Node, generic: Collection[str]) -> bool:
    """Return whether an equation is a condition on one undefined matrix: ``R.T*R == eye(3)`` or ``det(R) == 1``.

    ``generic`` are the names of the vectors and matrices that the claim uses without giving their entries.
    """
    nodes = nodes_of(left, right)
    names = {str(node.value) for node in nodes if node.kind == "name"}
    kinds = {node.kind if node.kind != "call" else str(node.value) for node in nodes}
    of_product = kinds <= {"name", "number", "neg", "product", "power", "transpose", "inverse", "eye"}
    of_value = kinds <= {"name", "number", "neg", "det", "trace"}
    return len(names) == 1 and names <= {*generic} and (of_product or of_value)


def _is_equation_of_matrix(claim: Claim, left: Node, right: Node, generic: Collection[str]) -> bool:
    """Return whether an equation restricts a letter by an undefined matrix: ``det(A - lambda*eye(3)) == 0``.

    ``generic`` are the names of the vectors and matrices that the claim uses without giving their entries.
    """
    nodes = nodes_of(left, right)
    names = {str(node.value) for node in nodes if node.kind == "name"} - {"pi"}
    has_value = any(node.kind == "call" and node.value in ("det", "trace") for node in nodes)
    is_open = len(names & {*generic}) == 1 and len(names) > 1 and not names - {*generic} & _known(claim)
    return has_value and is_open and number(0) in (left, right) and not _has_hidden_zero(claim, left, right)


def _has_own_angle(left: Node, right: Node, generic: Collection[str]) -> bool:
    """Return whether an equation defines the angle between two vectors, as ``a . b = |a| |b| cos(theta)`` does.

    ``generic`` are the names of the vectors that the claim uses without giving their components.
    """
    nodes = nodes_of(left, right)
    scalars = [node for node in nodes if node.kind == "name" and node.value not in generic and node.value != "pi"]
    angles = [
        node for node in nodes if node.kind == "call" and node.value in ("sin", "cos") and node.args[0] in scalars
    ]
    vectors = {str(node.value) for node in nodes if node.kind == "name"} & {*generic}
    # the angle must be the only scalar
    return len(scalars) == len(angles) == 1 and len(vectors) > 1


def _has_open_derivative(left: Node, right: Node, known: Collection[str]) -> bool:
    """Return whether an equation contains a derivative such as ``diff(L, q)`` of a name that is not in ``known``.

    ``known`` are the names that have a meaning. Time derivatives do not count.
    """
    # its value is unknown, so the equation is no identity; time derivatives are treated elsewhere
    for side in (left, right):
        for node in nodes_of(side):
            if is_derivative(node) and node.args[0].kind == "name":
                name, *variables = node.args
                if name.value not in known and name not in variables and any(v.value != "t" for v in variables):
                    return True
    return False


def _is_list_of_names(tree: Node) -> bool:
    """Return whether a tree is a vector or matrix whose entries are names or rates, such as ``[a, b, c']``."""
    is_list = tree.kind == "list" or (tree.kind == "call" and tree.value == "Matrix")
    if tree.kind == "list" and len(tree.args) == 2 and tree.args[0] == number(0):
        return is_name(tree.args[1])  # the quaternion (0, v)
    return is_list and all(is_name(part) or is_rate(part) or _is_list_of_names(part) for part in tree.args)


def _factors(tree: Node) -> list[Node]:
    """Return the factors of a product, or of every term of a sum, without exponents and signs: a, b for ``-a^2*b``."""
    if tree.kind in ("sum", "product", "neg"):
        return [factor for part in tree.args for factor in _factors(part)]
    return _factors(tree.args[0]) if tree.kind == "power" else [tree]


def _known(claim: Claim) -> set[str]:
    """Return the names that have a meaning: pi, the time t, and the names that the claim defines."""
    # Matrix([a_x, a_y, a_z]) only names the components of a, which defines nothing
    return {"pi", "t", *(name for name, tree in claim.define if not is_components(name, tree))}


def _equation_of_motion(left: Node, right: Node) -> NamedFormula | None:
    """Return the NamedFormula for x'', ``-k*x/m``, of a linear differential equation ``m*x'' + k*x = 0``.

    Return None for other equations.
    """
    if (parts := with_highest_rate(left, right)) is None:
        return None
    rate, coefficient, rest = parts
    return NamedFormula(str(rate.args[0].value), rate, quotient(rest, coefficient), True)
