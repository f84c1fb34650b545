"""Rules of differentiation, such as ``diff(x*y, q) == diff(x, q)*y + x*diff(y, q)``.

The letters x and y are functions of q, though the text does not write ``x(q)``. A rule is true if it holds for all
functions.
"""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from sympy import Expr, Symbol
from sympy.core.function import AppliedUndef

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.reader import with_time
from symrot.checker.claim.tree import TIME, Node, is_derivative, nodes_of, with_names
from symrot.exact import normal_form
from symrot.exact.decision import flatten
from symrot.exact.ring.ratio import TooLarge

__all__ = ["as_functions", "is_rule"]


def as_functions(claim: Claim) -> Claim | None:
    """Return a claim about derivatives with t in place of its variable q, and x(t) in place of each function x of q.

    ``diff(x*y, q) == x*diff(y, q) + y*diff(x, q)`` becomes the same claim about ``diff(x(t)*y(t), t)``. Return None for
    a claim with hypotheses, with derivatives with respect to several variables, or without a function of the variable.
    Return None also for a claim in which t has another meaning than the variable.
    """
    assert claim.relation is not None
    sign, *sides = claim.relation
    nodes = nodes_of(*sides)
    derivatives = [node for node in nodes if is_derivative(node)]
    variables = {argument for node in derivatives for argument in node.args[1:] if argument.kind != "number"}
    names = {str(node.args[0].value) for node in derivatives if node.args[0].kind == "name"}
    names -= {"t", "pi", *(str(variable.value) for variable in variables), *dict(claim.define)}
    functions = {str(node.value) for node in nodes if node.args == (TIME,)}
    moving = {*names, *functions, *dict(claim.define), *(str(variable.value) for variable in variables)}
    letters = [_letters(derivative.args[0]) for derivative in derivatives]
    names |= {name for inner in letters if moving.isdisjoint(inner) for name in inner} - {"pi"}
    # not a rule of differentiation: hypotheses, several variables, or (below) both t and another variable
    if claim.hypotheses or len(variables) != 1 or not names:
        return None
    # the variable is renamed to t: a rule of differentiation does not depend on its name, unless t is also in the claim
    (variable,) = variables
    if variable.kind != "name" or (variable != TIME and TIME in nodes):
        return None
    left, right = (with_time(with_names(side, {str(variable.value): "t"}), names) for side in sides)
    symbols = tuple(symbol for symbol in claim.symbols if symbol not in names)
    others = (*claim.functions, *(name for name in claim.symbols if name in names))
    notes = (*claim.notes, *_on_letters(names, derivatives, str(variable.value), dict(claim.define)))
    return replace(claim, relation=(sign, left, right), symbols=symbols, functions=others, alternatives=(),
                   sources={}, notes=notes)  # fmt: skip


def _letters(tree: Node) -> set[str]:
    """Return the names in a tree: those of symbols (x), and those of functions of time (f if ``f(t)`` occurs)."""
    return {str(node.value) for node in nodes_of(tree) if node.kind == "name" or node.args == (TIME,)}


def _on_letters(
    names: Collection[str], derivatives: Sequence[Node], variable: str, defined: Collection[str]
) -> Iterator[str]:
    """Yield notes that tell the user which letters are functions of ``variable``, and which are constants.

    The functions are ``names``. The constants are the other names in the formulas that ``derivatives`` differentiate,
    without those that the claim defines (``defined``).
    """
    yield f"{' and '.join(sorted(names))} {'is a function' if len(names) == 1 else 'are functions'} of {variable} here"
    letters = {str(node.value) for tree in derivatives for node in nodes_of(tree.args[0]) if node.kind == "name"}
    if constants := sorted(letters - {*names, *defined, variable, "t", "pi"}):
        yield f"{' and '.join(constants)} {'is a constant' if len(constants) == 1 else 'are constants'} here"


def is_rule(claim: Claim) -> bool:
    """Return whether a claim is a rule of differentiation, such as ``diff(u*v, t) == u*diff(v, t) + v*diff(u,
    t)``.
    """
    assert claim.relation is not None
    nodes = [nodes_of(side) for side in claim.relation[1:]]
    derivatives = [[node for node in side if is_derivative(node)] for side in nodes]
    sides = (claim.equation.left, claim.equation.right)
    values = [[_plain(value) for value in flatten(side)[0]] for side in sides]
    letters = [{letter for value in side for letter in value.atoms(Symbol, AppliedUndef)} for side in values]
    has_all = letters[0] <= letters[1] or letters[1] <= letters[0]
    # both sides differentiate, one of them a formula such as u*v: diff(x, t) == diff(y, t) is an equation for x
    # diff(y, x) == y is not a rule, but an equation for y
    return has_all and all(derivatives) and any(map(_is_of_formula, [*derivatives[0], *derivatives[1]]))


def _plain(value: Expr) -> Expr:
    """Return the normal form of a value, or the value itself if its normal form is too large."""
    try:
        return normal_form(value)
    except TooLarge:
        return value


def _is_of_formula(derivative: Node) -> bool:
    """Return whether a derivative is that of a sum, product or power, as ``diff(x*y, t)``, with no derivative
    inside.
    """
    inner = derivative.args[0]
    return inner.kind in ("sum", "product", "power") and not any(is_derivative(node) for node in nodes_of(inner))
