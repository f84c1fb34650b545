"""Claims about real powers, roots of negative expressions, logarithms, inverse functions and towers, for the campaign.

A claim sets a formula equal to its rewriting by a rule of real functions (which holds wherever both sides have a
value), by a wrong rule, or to something else. Sides that have a value nowhere are included: nothing may be called true
of them. :mod:`tests.campaigns.checker.oracle_real` judges the truth, point by point, of the verdict and of its
evidence.
"""

import re
from collections.abc import Iterator, Sequence
from fractions import Fraction
from random import Random

from symrot.checker.claim.reader import read_expression, read_relation
from symrot.checker.claim.tree import Node, replaced, text, walk
from symrot.checker.interface import check
from symrot.checker.verdict import Verdict
from tests.campaigns.checker.oracle_real import (
    NAMES,
    NoValue,
    Unclear,
    compare,
    drawn_point,
    far_point,
    has_values,
    lacks_a_value,
    real_value,
)
from tests.campaigns.checker.run import Judged, answer_of

__all__ = ["REAL_RULES", "TRAPS", "fault", "judged_real", "real_claims"]

REAL_RULES = (
    ("sqrt(X)*sqrt(Y)", "sqrt(X*Y)"), ("sqrt(X)", "X/sqrt(X)"), ("sqrt(X)**2", "X"), ("sqrt(X**2)", "abs(X)"),
    ("sqrt(X)", "X**(1/2)"), ("sqrt(X/Y)", "sqrt(X)/sqrt(Y)"), ("1/sqrt(X)", "X**(-1/2)"), ("abs(X)", "sqrt(X**2)"),
    ("X**(1/3)", "(X**2)**(1/6)"), ("X**(2/3)", "(X**2)**(1/3)"), ("X**(2/3)", "(X**(1/3))**2"),
    ("X**(1/3)", "X/X**(2/3)"), ("X**(1/4)", "(X**3)**(1/12)"), ("X**(-1/3)", "1/X**(1/3)"),
    ("X**(1/3)", "sqrt(X**(2/3))"), ("(X**2)**(1/4)", "sqrt(-X)"), ("X**(1/4)", "sqrt(sqrt(X))"),
    ("X**(3/2)", "X*sqrt(X)"),
    ("X**(1/3)*Y**(1/3)", "(X*Y)**(1/3)"), ("X**(1/3)*X**(2/3)", "X"), ("(X**3)**(1/3)", "X"),
    ("log(X)", "2*log(sqrt(X))"), ("log(X)", "log(X**3)/3"), ("log(X*Y)", "log(X) + log(Y)"),
    ("log(X/Y)", "log(X) - log(Y)"), ("log(X)", "log(X**2)/2"), ("log(X**2)", "2*log(abs(X))"), ("log(X)", "-log(1/X)"),
    ("log(exp(X))", "X"), ("exp(log(X))", "X"), ("exp(X)", "1/exp(-X)"), ("exp(X + Y)", "exp(X)*exp(Y)"),
    ("X", "log(exp(X))"), ("exp(X)", "exp(X/2)**2"), ("exp(X)", "cosh(X) + sinh(X)"), ("exp(log(X)/3)", "X**(1/3)"),
    ("cosh(X)", "sqrt(1 + sinh(X)**2)"), ("tanh(X)", "sinh(X)/cosh(X)"), ("sinh(2*X)", "2*sinh(X)*cosh(X)"),
    ("cosh(X)**2", "1 + sinh(X)**2"), ("sinh(X)", "-sinh(-X)"),
    ("asin(X)", "pi/2 - acos(X)"), ("acos(X)", "pi/2 - asin(X)"), ("asin(X)", "-asin(-X)"),
    ("acos(X)", "pi - acos(-X)"),
    ("asin(X)", "atan2(X, sqrt(1 - X**2))"), ("atan(X)", "asin(X/sqrt(1 + X**2))"), ("atan(X)", "-atan(-X)"),
    ("sin(asin(X))", "X"), ("cos(asin(X))", "sqrt(1 - X**2)"), ("sin(acos(X))", "sqrt(1 - X**2)"),
    ("tan(atan(X))", "X"),
    ("cos(acos(X))", "X"), ("cos(atan(X))", "1/sqrt(1 + X**2)"), ("sin(2*asin(X))", "2*X*sqrt(1 - X**2)"),
    ("sin(X)**2", "1 - cos(X)**2"), ("tan(X)", "sin(X)/cos(X)"), ("sin(X)", "cos(pi/2 - X)"), ("abs(X)", "abs(-X)"),
    ("abs(X*Y)", "abs(X)*abs(Y)"), ("X", "X + 0*log(Y)"), ("X", "X + Y - Y"), ("X", "X*Y/Y"), ("X", "2*X - X"),
    ("X + Y", "Y + X"), ("X*Y", "Y*X"), ("X", "(X**2 - 1)/(X - 1) - 1"), ("X", "X + sqrt(Y) - sqrt(Y)"),
    ("X", "X + asin(Y) - asin(Y)"), ("X", "X*(Y**(1/3))/(Y**(1/3))"),
    ("log(X**2*Y)", "2*log(abs(X)) + log(Y)"), ("exp(Y*log(X**2))", "exp(2*Y*log(abs(X)))"),
    ("exp(Y*log(X))*X", "exp((Y + 1)*log(X))"), ("exp(Y*log(X))", "exp(-Y*log(1/X))"), ("log(26*X)", "log(2) + log(13*X)"),
    ("sqrt(X/Y)*sqrt(Y/X)", "1"), ("sqrt(X*Y)*abs(X)*abs(Y)", "sqrt(X*Y)*X*Y"), ("sqrt(-X)*abs(X)", "-sqrt(-X)*X"),
    ("sin(X)", "sin(X*(sin(Y)**2 + cos(Y)**2))"), ("cos(tan(X))", "cos(sin(X)/cos(X))"), ("abs(log(X*Y))", "abs(log(Y*X))"),
)  # fmt: skip
"""Left and right have one value wherever both have one."""

TRAPS = (
    ("sqrt(X**2)", "X"), ("abs(X)", "X"), ("sqrt(X)", "-sqrt(X)"), ("sqrt(X + Y)", "sqrt(X) + sqrt(Y)"),
    ("X**(1/3)", "-(-X)**(1/3)"), ("(-X)**(1/3)", "-X**(1/3)"), ("X**(2/3)", "X**(1/3)"),
    ("log(X)", "log(-X)"), ("log(X + Y)", "log(X) + log(Y)"), ("log(X**2)", "log(X)"), ("exp(X)", "exp(-X)"),
    ("asin(X)", "acos(X)"), ("asin(sin(X))", "X"), ("acos(cos(X))", "X"), ("atan(tan(X))", "X"),
    ("acos(X)", "acos(-X)"),
    ("atan(X)", "pi/2 - atan(1/X)"), ("cosh(X)", "sinh(X)"), ("cosh(X)", "-sqrt(1 + sinh(X)**2)"), ("X", "-X"),
    ("cos(asin(X))", "-sqrt(1 - X**2)"), ("sin(X)", "sqrt(1 - cos(X)**2)"), ("X", "abs(X)"), ("X", "7"), ("X", "5*X"),
    ("sqrt(X*Y)*abs(X)", "sqrt(X*Y)*X"), ("abs(X)*abs(Y)", "X*Y"), ("log(X*Y)", "2*log(X)"), ("exp(Y*log(X))", "exp(X*log(Y))"),
    ("log(X*Y)", "log(abs(X)) - log(abs(Y))"), ("log(X)", "log(X**2)"), ("sqrt(X/Y)", "sqrt(Y/X)"),
    ("sqrt(X)*sqrt(Y)", "-sqrt(X*Y)"), ("X**(1/3)", "(X**3)**(1/9)*X"), ("log(X)", "abs(log(X))"),
)  # fmt: skip
"""Left and right differ for most values, or have none together."""

PIECES = (
    "x", "y", "z", "-x", "x - 1", "1 - x", "x + y", "x*y", "x/y", "x**2 + 1", "-x**2 - 1", "-x**2", "x**2 - y**2", "2",
    "1/2", "-8", "-2", "-27", "3", "-1", "-1/2", "sin(x)", "cos(x) - 2", "sin(x) - 1", "2 + cos(y)", "exp(x)",
    "-exp(x)",
    "exp(x) + 2", "-abs(x)", "abs(x)", "abs(y) + 1", "log(x)", "log(y)", "sqrt(x)", "-sqrt(x)", "sqrt(x - y)", "-pi",
    "x**(1/3)", "(-x)**(1/3)", "asin(x)", "acos(y)", "atan(x)", "tan(y)", "tanh(x)", "cosh(x)", "-cosh(x)", "pi/4",
    "asin(x) + 3", "log(x) - log(x)", "1/x", "-1/x**2", "sqrt(2)", "-sqrt(2)", "cos(1) - 1", "log(1/2)", "x**4 - x + 5",
)  # fmt: skip

SEEDS = (
    "sqrt(X)", "X**(1/3)", "X**(2/3)*Y", "X**(1/5) + Y", "log(X)", "log(X)*Y", "asin(X)", "acos(X) + Y", "atan(X)*Y",
    "sqrt(X)*sqrt(Y)", "X**(1/3)*Y**(1/3)", "log(X) + log(Y)", "log(X*Y)", "exp(log(X))", "log(exp(X))", "sqrt(X**2)",
    "exp(X)*exp(Y)", "X**(-1/3)", "1/sqrt(X)", "sqrt(X/Y)", "Y*X**(1/4)", "X + Y", "X*Y", "0*log(X) + Y", "abs(X)*Y",
    "Y - Y + sqrt(X)", "Y*(X**(1/3))", "sin(asin(X))", "cos(asin(X))", "tan(atan(X))", "sin(acos(X))*Y", "cosh(X)",
    "sinh(X)*Y", "tanh(X)", "tan(X)", "X**(3/2)", "(X**3)**(1/3)", "(X**2)**(1/3)", "asin(sin(X))", "acos(cos(X))",
    "atan2(X, Y)", "sqrt(1 - X**2)*Y", "X/(Y - Y + X)", "log(abs(X))", "sqrt(abs(X))",
    "log(X**2*Y)", "exp(Y*log(X))", "sqrt(X/Y)*sqrt(Y/X)", "abs(X)*abs(Y)", "sin(X)*sqrt(X*Y)", "log(X)**2*log(X*Y)",
)  # fmt: skip

TOWERS = ("sin", "cos", "exp", "log", "sqrt", "asin", "acos", "atan", "cosh", "sinh", "tanh", "abs", "tan")
MOST_TOWER = 9

LONGEST = 400

_COMPILED, _TRAPS = (
    tuple((read_expression(left), read_expression(right)) for left, right in rules) for rules in (REAL_RULES, TRAPS)
)
_LETTERS = ("X", "Y")


def real_claims(count: int, seed: int = 0) -> Iterator[str]:
    """Yield claims as text; equal seeds give equal claims."""
    source = Random(seed)
    made = 0
    while made < count:
        left = right = _start(source)
        kind = source.randrange(8)
        for _ in range(source.randint(1, 3)):
            right = _rewritten(right, source, _COMPILED)
        if source.random() < 0.4:
            left = _rewritten(left, source, _COMPILED)
        if kind in (5, 6):
            right = _rewritten(right, source, _TRAPS)
        elif kind == 7:
            right = read_expression(source.choice((*PIECES, "7", "0", "5*x")))
        claim = f"{text(left)} == {text(right)}"
        if len(claim) <= LONGEST and left != right:
            made += 1
            yield claim


def _start(source: Random) -> Node:
    if source.random() < 0.15:
        inside = source.choice(PIECES)
        for _ in range(source.randint(2, MOST_TOWER)):
            inside = f"{source.choice(TOWERS)}({inside})"
        return read_expression(inside)
    node = read_expression(source.choice(SEEDS))
    for _ in range(source.choice((1, 1, 1, 2))):
        letters = {letter: read_expression(source.choice((*PIECES, *SEEDS[:12]))) for letter in _LETTERS}
        node = _filled(node, letters)
    return read_expression(text(_filled(node, {letter: read_expression(source.choice(PIECES)) for letter in _LETTERS})))


def _filled(pattern: Node, found: dict[str, Node]) -> Node:
    if pattern.kind == "name" and pattern.value in found:
        return found[pattern.value]
    return Node(pattern.kind, pattern.value, tuple(_filled(child, found) for child in pattern.args))


def _rewritten(tree: Node, source: Random, rules: Sequence[tuple[Node, Node]]) -> Node:
    """Return a tree after one random rule at one random piece that it fits."""
    places = [(path, node) for path, node in walk(tree) if not _in_exponent(tree, path)]
    for _ in range(80):
        path, node = source.choice(places)
        left, right = source.choice(rules)
        found: dict[str, Node] = {}
        if _matched(left, node, found):
            found.setdefault("Y", read_expression(source.choice(PIECES)))
            made = _filled(right, found)
            return read_expression(text(replaced(tree, path, made)))
    return tree


def _in_exponent(tree: Node, path: Sequence[int]) -> bool:
    for place in path:
        if tree.kind == "power" and place == 1:
            return True
        tree = tree.args[place]
    return False


def _matched(pattern: Node, node: Node, found: dict[str, Node]) -> bool:
    if pattern.kind == "name" and pattern.value in _LETTERS:
        return found.setdefault(pattern.value, node) == node
    if pattern.kind != node.kind or pattern.value != node.value or len(pattern.args) != len(node.args):
        return False
    return all(_matched(p, n, found) for p, n in zip(pattern.args, node.args, strict=True))


# -- judging ----------------------------------------------------------------------------------------------------------

POINTS, MOST_POINTS, FAR_POINTS = 40, 2000, 4000
"""Points looked at; where none of them is one of the domain, more are, and then more of all sizes."""

_OF_THE_DOMAIN = ("nowhere", "no real", "not negative", "a positive number", "from -1 to 1", "zero everywhere",
                  "that is not zero", "real numbers")  # fmt: skip
"""Words of a refusal that says that a side has no value."""


def fault(claim: str, verdict: Verdict | str, source: Random) -> str:
    """Return a text about the fault of a verdict or of a refusal; empty if there is no fault.

    Parameters
    ----------
    claim : str
        ``left == right`` with the names of :data:`tests.campaigns.checker.oracle_real.NAMES`.
    verdict : Verdict or str
        The verdict, or the sentence by which the claim was refused.
    source : Random
        The source of the random points.
    """
    _, left, right = read_relation(claim)
    if isinstance(verdict, str):
        if any(words in verdict for words in _OF_THE_DOMAIN) and has_values((left, right), MOST_POINTS // 2):
            return f"refused as if it had no value: {verdict}"
        return ""
    if verdict.verdict in ("undecided", "definition"):  # nothing is claimed
        return ""
    if verdict.verdict == "true":
        return _fault_of_true(left, right, source, ())
    if verdict.verdict == "conditional":
        wrong = [_fault_of_true(left, right, source, read) for read in map(_conditions, verdict.requires)]
        return next((f"{sentence}, under its condition" for sentence in wrong if sentence), "")
    shown = verdict.counterexample
    if shown is None:
        return "false without a counterexample"
    try:
        point = {name: _number(value) for name, value in shown.values.items()}
        same = compare(_placed(left, point), _placed(right, point), dict.fromkeys(NAMES, Fraction(1)))
    except NoValue:
        named = {node.value for side in (left, right) for _, node in walk(side) if node.kind == "name"}
        whole = named & {*NAMES} <= shown.values.keys()  # names that SymPy cancelled are not named in the point
        return "false by a point at which a side has no value" if whole else ""
    except Unclear:
        return ""
    return "false by a point at which the sides are equal" if same else ""


def _fault_of_true(left: Node, right: Node, source: Random, conditions: Sequence[tuple[str, Node, Node]]) -> str:
    defined, unclear = 0, 0
    for number in range(MOST_POINTS + FAR_POINTS):
        if number >= MOST_POINTS and (defined or unclear):
            break
        point = drawn_point(source) if number < MOST_POINTS else far_point(source)
        try:
            if not all(_obeyed(condition, point) for condition in conditions):
                continue
            if not compare(left, right, point):
                return "true, but not at " + ", ".join(f"{name} = {value}" for name, value in point.items())
        except NoValue:
            continue
        except Unclear:
            unclear += not lacks_a_value((left, right), point)
            continue
        defined += 1
        if defined >= POINTS // 4 and number >= POINTS:
            break
    return "" if defined or unclear else "true of nothing: no point has a value on both sides"


def _conditions(requirement: str) -> list[tuple[str, Node, Node]]:
    return [condition for part in requirement.split(" and ") for condition in _links(part)]


def _links(condition: str) -> Iterator[tuple[str, Node, Node]]:
    """Yield the relations of a condition such as ``0 <= x < pi``."""
    pieces = re.split(r"([<>!=]=|[<>])", condition)
    for left, sign, right in zip(pieces[::2], pieces[1::2], pieces[2::2], strict=False):
        yield sign, read_expression(left), read_expression(right)


def _obeyed(condition: tuple[str, Node, Node], point: dict[str, Fraction]) -> bool:
    sign, left, right = condition
    value = real_value(left, point) - real_value(right, point)
    if value != 0 and abs(value) < 1e-20:
        raise Unclear
    signs = {"==": value == 0, ">=": value >= 0, ">": value > 0, "<=": value <= 0, "<": value < 0, "!=": value != 0}
    return bool(signs[sign])


def _number(shown: str) -> Node:
    return read_expression(shown)


def _placed(side: Node, point: dict[str, Node]) -> Node:
    """Return a side with a counterexample's values in place of its names; sines of a name are unclear."""
    if any(name not in NAMES for name in point):
        raise Unclear
    return read_expression(text(_filled(side, point)))


def judged_real(seed: int, number: int, claim: str) -> Judged:
    """Check one claim and judge the verdict."""
    answer = answer_of(lambda: check(claim, repair=False))
    wrong = answer.failure or fault(claim, answer.verdict, Random(f"{seed} {number}"))
    return Judged(number, claim, answer.name, answer.seconds, wrong)
