"""A campaign against the checker: generated claims whose truth is known by other means; no wrong verdict may pass.

Rewriting a random formula by named rules (angle addition, the distributive law, ``(A B)^T = B^T A^T``) gives true
claims. One random edit of a true claim gives a false one, confirmed at rational points by exact arithmetic that shares
nothing with the engine. ``python -m tests.campaigns.checker.identities --count N`` runs it; with ``--real`` the claims
come from :mod:`tests.campaigns.checker.real_identities`: real powers, roots of negative expressions, logarithms,
inverse functions outside their domains, and towers of functions.
"""

import sys
from argparse import ArgumentParser
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from random import Random
from typing import Any

from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.tree import Node, number, product, replaced, sum_of, text, walk
from symrot.checker.interface import check
from symrot.checker.repair.edits.single import single_edits
from symrot.errors import InputError
from tests.campaigns.checker.oracle import ANGLES, FUNCTIONS, QUATERNIONS, SYMBOLS
from tests.campaigns.checker.oracle_extended import EXPONENTS, HYPOTHESES, INVERSES, truth_under
from tests.campaigns.checker.real_identities import judged_real, real_claims
from tests.campaigns.checker.run import Judged, Tally, answer_of, judged_claims, read_log

__all__ = ["RULES", "campaign", "claims", "main"]

RULES = (
    ("sin(A + B)", "sin(A)*cos(B) + cos(A)*sin(B)"), ("cos(A + B)", "cos(A)*cos(B) - sin(A)*sin(B)"),
    ("sin(A - B)", "sin(A)*cos(B) - cos(A)*sin(B)"), ("cos(A - B)", "cos(A)*cos(B) + sin(A)*sin(B)"),
    ("sin(2*A)", "2*sin(A)*cos(A)"), ("cos(2*A)", "1 - 2*sin(A)**2"), ("cos(2*A)", "2*cos(A)**2 - 1"),
    ("sin(3*A)", "3*sin(A) - 4*sin(A)**3"), ("cos(3*A)", "4*cos(A)**3 - 3*cos(A)"),
    ("sin(A)", "2*sin(A/2)*cos(A/2)"), ("cos(A)", "1 - 2*sin(A/2)**2"), ("sin(A)", "cos(A - pi/2)"),
    ("cos(A)", "sin(A + pi/2)"), ("sin(A)", "-sin(A + pi)"), ("sin(A)**2", "1 - cos(A)**2"),
    ("cos(A)**2", "(1 + cos(2*A))/2"), ("sin(A)*cos(B)", "(sin(A + B) + sin(A - B))/2"),
    ("cos(A)*cos(B)", "(cos(A - B) + cos(A + B))/2"), ("sin(A)*sin(B)", "(cos(A - B) - cos(A + B))/2"),
    ("tan(A)", "sin(A)/cos(A)"), ("tan(A)", "sin(2*A)/(1 + cos(2*A))"), ("sin(A)", "tan(A)*cos(A)"),
    ("X*(Y + Z)", "X*Y + X*Z"), ("(X + Y)*Z", "X*Z + Y*Z"), ("(X + Y)**2", "X**2 + 2*X*Y + Y**2"),
    ("X**2", "(X - 1)*(X + 1) + 1"), ("X/Y", "X*Y/Y**2"), ("X - Y", "(X**2 - Y**2)/(X + Y)"),
    ("X", "X*(sin(a)**2 + cos(a)**2)"), ("X", "X + y - y"), ("X", "2*X - X"), ("X", "X*z/z"), ("X", "(3*X + X)/4"),
    ("X", "-(-X)"), ("X*Y", "((X + Y)**2 - (X - Y)**2)/4"), ("1", "cos(b)**2 + sin(b)**2"),
    ("Rx(A)", "Rx(-A).T"), ("Ry(A)", "Ry(A/2)*Ry(A/2)"), ("Rz(A)", "Rz(A + b)*Rz(-b)"),
    ("Rz(A)", "Rz(A)*Rx(c)*Rx(c).T"),
    ("skew(X, Y, Z)", "-skew(X, Y, Z).T"), ("cross(U, V)", "-cross(V, U)"), ("dot(U, V)", "dot(V, U)"),
    ("qmul(P, qmul(Q, P))", "qmul(qmul(P, Q), P)"), ("dcm_of(qmul(P, Q))", "dcm_of(P)*dcm_of(Q)"),
    ("diff(sin(F), t)", "cos(F)*diff(F, t)"), ("diff(cos(F), t)", "-sin(F)*diff(F, t)"),
    ("diff(X*Y, t)", "diff(X, t)*Y + X*diff(Y, t)"), ("diff(X + Y, t)", "diff(X, t) + diff(Y, t)"),
    ("sqrt(X**2)", "abs(X)"), ("abs(X)", "sqrt(X**2)"), ("abs(X*Y)", "abs(X)*abs(Y)"), ("abs(X)**2", "X**2"),
    ("abs(cos(A))", "sqrt((1 + cos(2*A))/2)"), ("abs(sin(A))", "sqrt(1 - cos(A)**2)"), ("abs(X)", "abs(-X)"),
    ("abs(X/Y)", "abs(X)/abs(Y)"), ("abs(X)", "X**2/abs(X)"),
    ("exp(H + J)", "exp(H)*exp(J)"), ("exp(H - J)", "exp(H)/exp(J)"), ("exp(H)", "exp(H/2)**2"),
    ("exp(H)", "1/exp(-H)"), ("exp(2*H)", "exp(H)**2"), ("exp(H)*exp(J)", "exp(H + J)"),
    ("cos(2*asin(k))", "1 - 2*k**2"), ("sin(asin(k))", "k"), ("cos(acos(k))", "k"), ("tan(atan(l))", "l"),
    ("cos(asin(k))", "sqrt(1 - k**2)"), ("sin(acos(k))", "sqrt(1 - k**2)"), ("sin(2*atan(l))", "2*l/(1 + l**2)"),
    ("cos(2*atan(l))", "(1 - l**2)/(1 + l**2)"), ("sin(2*asin(k))", "2*k*cos(asin(k))"),
    ("cos(A + asin(k))", "cos(A)*cos(asin(k)) - k*sin(A)"), ("sin(A + atan(l))", "cos(atan(l))*(sin(A) + l*cos(A))"),
)  # fmt: skip
"""Left and right of identities; A, B angles, X, Y, Z scalars, U, V columns, P, Q quaternions, F a function of time,
H, J exponents."""

SEEDS = (
    "sin(a + b)*cos(c)", "x*sin(a) + y*cos(b)", "(x + y)*(z - x)", "cos(2*a) + sin(b)**2", "tan(a)*x",
    "x/y + z*cos(3*a)", "sin(a)*sin(b)*sin(c)", "(x*cos(a) - y*sin(a))**2 + (x*sin(a) + y*cos(a))**2",
    "cos(a/2)*sin(b - c)", "x**2*y - z/x",
    "Rx(a)*Ry(b)", "Rz(a)*Rx(b)*Rz(c)", "Ry(a).T*skew(x, y, z)*Ry(a)", "skew(x, y, z)*skew(x, y, z)",
    "Rx(a)*Matrix([x, y, z])", "cross(Rz(a)*Matrix([x, y, z]), Matrix([y, z, x]))", "det(Rx(a)*diag(x, y, z))",
    "dot(Matrix([x, y, z]), Rx(b)*Matrix([z, x, y]))", "qmul((p0, p1, p2, p3), (q0, q1, q2, q3))",
    "dcm_of(qmul((p0, p1, p2, p3), (q0, q1, q2, q3)))", "diff(sin(phi(t))*cos(theta(t)), t)", "diff(Rz(phi(t)), t)",
    "diff(x*cos(phi(t))**2, t)", "vee(Rz(phi(t)).T*diff(Rz(phi(t)), t))",
    "trace(Rx(a)*Rz(b))", "(Rx(a)*Rz(b)).T", "inverse(Rx(a))*Ry(c)", "diff(Rx(theta(t))*Rz(phi(t)), t)",
)  # fmt: skip

WIDER_SEEDS = (
    "sqrt(x**2*y**2) + abs(z)", "abs(x)*abs(y - z)", "abs(cos(a))*x + abs(sin(a))*y", "abs(x*y)/abs(z)",
    "sqrt(x**2 + 2*x*y + y**2)", "sqrt((x*cos(a))**2)*sqrt(y**2)",
    "exp(u + v)*x + exp(2*u)", "exp(u - v)*sin(a)", "x*exp(u)*exp(v) + y/exp(u)",
    "Rz(a)*Matrix([x*exp(u), exp(-v), z])",
    "cos(asin(k))*x + k", "sin(a + asin(k))", "cos(2*atan(l))*y + sin(2*atan(l))", "sin(2*acos(k))*z",
    "tan(atan(l))*x + cos(acos(k))", "cos(a + asin(k))*cos(b)", "sin(a + atan(l))*x",
)  # fmt: skip
"""Roots, exponentials and inverse functions."""

UNIT_P, UNIT_Q, UNIT_V, UNIT_XY, PRODUCT = HYPOTHESES
UNDER: tuple[tuple[tuple[str, ...], tuple[str, ...], tuple[tuple[str, str], ...]], ...] = (
    ((UNIT_P,), ("dcm_of(p0, p1, p2, p3)*Matrix([x, y, z])", "dcm_of(p0, p1, p2, p3)*skew(x, y, z)", "p0**2 - p3**2",
                 "trace(dcm_of(p0, p1, p2, p3))"),
     (("1", "p0**2 + p1**2 + p2**2 + p3**2"), ("p0**2", "1 - p1**2 - p2**2 - p3**2"),
      ("X", "X*det(dcm_of(p0, p1, p2, p3))"), ("trace(dcm_of(p0, p1, p2, p3))", "4*p0**2 - 1"),
      ("dcm_of(p0, p1, p2, p3)", "inverse(dcm_of(p0, p1, p2, p3)).T"))),
    ((UNIT_P, UNIT_Q), ("qmul((p0, p1, p2, p3), (q0, q1, q2, q3))", "dcm_of(p0, p1, p2, p3)*dcm_of(q0, q1, q2, q3)",
                        "p0*q0 + p1*q1 + x"),
     (("dcm_of(p0, p1, p2, p3)*dcm_of(q0, q1, q2, q3)", "dcm_of(qmul((p0, p1, p2, p3), (q0, q1, q2, q3)))"),
      ("X", "X*(p0**2 + p1**2 + p2**2 + p3**2)"), ("X", "X + q0**2 + q1**2 + q2**2 + q3**2 - 1"))),
    ((UNIT_V,), ("skew(x, y, z)*skew(x, y, z)", "x*sin(a) + y*z", "(x*y + z)**2", "skew(x, y, z)*Matrix([z, x, y])"),
     (("x**2", "1 - y**2 - z**2"), ("1", "x**2 + y**2 + z**2"), ("X", "X*(x**2 + y**2 + z**2)"),
      ("skew(x, y, z)", "-skew(x, y, z)*skew(x, y, z)*skew(x, y, z)"),
      ("skew(x, y, z)*skew(x, y, z)", "Matrix([x, y, z])*Matrix([x, y, z]).T - diag(1, 1, 1)"))),
    ((UNIT_XY,), ("(x + y)**2", "x**4 - y**4", "x*cos(a) + y*sin(a)", "Matrix([[x, -y], [y, x]])*Matrix([z, x])"),
     (("x**2", "1 - y**2"), ("1", "x**2 + y**2"), ("X", "X*(x**2 + y**2)"),
      ("(x + y)**2", "1 + 2*x*y"), ("x**4 - y**4", "x**2 - y**2"))),
    ((PRODUCT,), ("x*y + z", "(x + y)**2 - z", "z*sin(a) - x*y*cos(a)", "Rx(a)*Matrix([z, x, y])"),
     (("z", "x*y"), ("x*y", "z"), ("X", "X + z - x*y"), ("z", "2*z - x*y"))),
)  # fmt: skip
"""Hypotheses, seeds, and rules that hold under them."""


# -- claims -----------------------------------------------------------------------------------------------------------

_KINDS = {"A": "angle", "B": "angle", "X": "scalar", "Y": "scalar", "Z": "scalar", "U": "matrix", "V": "matrix",
          "P": "matrix", "Q": "matrix", "F": "function", "H": "exponent", "J": "exponent"}  # fmt: skip
NOT_INSIDE = ("Rx", "Ry", "Rz", "sin", "cos", "tan", "exp", *INVERSES, *FUNCTIONS)
"""Functions whose arguments are left as they are: an angle is to stay one."""

LONGEST = 1500
"""Letters of a claim."""

_MATRICES = ("Rx", "Ry", "Rz", "skew", "cross", "Matrix", "qmul", "dcm_of", "vee", "diag", "inverse")


def is_matrix(node: Node) -> bool:
    """Return whether a piece of a generated claim is a matrix."""
    if node.kind == "call":
        return node.value in _MATRICES or (node.value == "diff" and is_matrix(node.args[0]))
    if node.kind == "list":
        return True
    return node.kind not in ("name", "number") and any(map(is_matrix, node.args))


def _fits(kind: str, node: Node) -> bool:
    if kind == "matrix":
        return is_matrix(node)
    if kind == "function":
        return node.kind == "call" and node.value in FUNCTIONS
    if is_matrix(node):
        return False
    names = {piece.value for _, piece in walk(node) if piece.kind == "name"} - {"t", "pi"}
    if kind == "exponent":
        return bool(names) and names <= {*EXPONENTS}
    calls = {piece.value for _, piece in walk(node) if piece.kind == "call"}
    if kind == "angle":
        return names <= {*ANGLES} and calls <= {*FUNCTIONS} and node.kind != "number"
    known = {*SYMBOLS, *ANGLES, *INVERSES.values(), *EXPONENTS, *(name for q in QUATERNIONS for name in q)}
    inside = names & {*ANGLES, *EXPONENTS}
    return names <= known and (not inside or bool(calls & {"sin", "cos", "tan", "exp"}))


def _matched(pattern: Node, node: Node, found: dict[str, Node]) -> bool:
    """Return whether the pattern, with its letters replaced, is the piece; write the replacements into ``found``."""
    if pattern.kind == "name" and pattern.value in _KINDS:
        if pattern.value in found:
            return found[pattern.value] == node
        found[pattern.value] = node
        return _fits(_KINDS[pattern.value], node)
    if pattern.kind != node.kind or pattern.value != node.value or len(pattern.args) != len(node.args):
        return False
    return all(_matched(p, n, found) for p, n in zip(pattern.args, node.args, strict=True))


def _filled(pattern: Node, found: dict[str, Node]) -> Node:
    if pattern.kind == "name" and pattern.value in found:
        return found[pattern.value]
    args = [_filled(child, found) for child in pattern.args]
    if pattern.kind == "sum":
        return sum_of(args)
    if pattern.kind == "product":
        return product(args)
    if pattern.kind == "neg":
        return product([number(-1), args[0]]) if args[0].kind == "number" else product([Node("neg", None, (args[0],))])
    return Node(pattern.kind, pattern.value, tuple(args))


Rules = Sequence[tuple[Node, Node]]


def _compiled(rules: Sequence[tuple[str, str]]) -> Rules:
    return tuple((read_expression(left), read_expression(right)) for left, right in rules)


_COMPILED = _compiled(RULES)
_UNDER = tuple((given, seeds, (*_compiled(rules), *_COMPILED)) for given, seeds, rules in UNDER)


def rewritten(tree: Node, source: Random, rules: Rules = _COMPILED) -> Node:
    """Return a tree after one random rule at one random piece, read again as text."""
    places = [(path, node) for path, node in walk(tree) if node.kind not in ("list",)]
    for _ in range(60):
        path, node = source.choice(places)
        if _inside(tree, path, NOT_INSIDE) or path_in_exponent(tree, path):
            continue
        left, right = source.choice(rules)
        found: dict[str, Node] = {}
        if _matched(left, node, found) and (found or node.kind != "name"):
            made = _filled(right, found)
            return read_expression(text(replaced(tree, path, made)))
    return tree


def _inside(tree: Node, path: Sequence[int], names: Sequence[str]) -> bool:
    """Return whether a piece is an argument of one of these functions, or a variable of differentiation."""
    for place in path:
        if tree.kind == "call" and (tree.value in names or (tree.value == "diff" and place)):
            return True
        tree = tree.args[place]
    return False


def path_in_exponent(tree: Node, path: Sequence[int]) -> bool:
    """Return whether a piece is an exponent or a part of one."""
    for place in path:
        if tree.kind == "power" and place == 1:
            return True
        tree = tree.args[place]
    return False


Generated = tuple[str, tuple[str, ...], bool]
"""A claim, its hypotheses, and whether it is true."""


def claims(count: int, seed: int = 0) -> Iterator[Generated]:
    """Yield generated claims as text with their hypotheses and their truth: half of them true."""
    source = Random(seed)
    made = 0
    while made < count:
        given, seeds, rules = _setting(source)
        left = right = read_expression(source.choice(seeds))
        for _ in range(source.randint(2, 5)):
            right = rewritten(right, source, rules)
        if source.random() < 0.5:
            left = rewritten(left, source, rules)
        if left == right or len(text(left)) + len(text(right)) > LONGEST or _nested(left) or _nested(right):
            continue
        if truth_under(left, right, given, source, 1) is not True:
            continue
        wanted = made % 2 == 0
        if not wanted:
            edits = list(single_edits(right, [*SYMBOLS, *ANGLES], FUNCTIONS, is_matrix, moving=False))
            right = source.choice(edits).tree
            if truth_under(left, right, given, source) is not False:
                continue
        made += 1
        yield f"{text(left)} == {text(right)}", given, wanted


def _nested(node: Node, inside: bool = False) -> bool:
    """Return whether a determinant contains another one, whose degree is too large: 72 for a matrix quadratic in a
    quaternion.
    """
    here = node.kind == "call" and node.value == "det"
    return (here and inside) or any(_nested(child, inside or here) for child in node.args)


def _setting(source: Random) -> tuple[tuple[str, ...], Sequence[str], Rules]:
    """Return hypotheses, seeds and rules: half of all claims are plain, a quarter has more functions, a quarter
    hypotheses.
    """
    chosen = source.randrange(4)
    if chosen < 2:
        return (), SEEDS, _COMPILED
    return ((), WIDER_SEEDS, _COMPILED) if chosen == 2 else source.choice(_UNDER)


RIGHT = {"true claims: true", "false claims: false", "false claims: conditional", "true claims: undecided",
         "false claims: undecided", "true claims: refused", "false claims: refused"}  # fmt: skip
"""What may be said of a true and of a false claim; that a false claim holds under a condition is no error.

An edit may make a claim that has no meaning, which is refused for good reason.
"""

MOST_OPEN = 0.01
"""Share of claims that may be undecided, or true and refused."""


def judged(number: int, generated: Generated) -> Judged:
    """Check one claim whose truth is known, and judge the verdict."""
    claim, given, true = generated
    shown = claim + "".join(f", given {hypothesis}" for hypothesis in given)
    answer = answer_of(lambda: check(claim, assume=given, repair=False))
    verdict = f"{'true' if true else 'false'} claims: {answer.name}"
    wrong = answer.failure or ("" if verdict in RIGHT else f"a {'true' if true else 'false'} claim is {answer.name}")
    refused = answer.verdict if true and isinstance(answer.verdict, str) and not answer.failure else ""
    return Judged(number, shown, verdict, answer.seconds, wrong, refused)


def campaign(count: int, seed: int = 0, real: bool = False, workers: int = 1, log: Path | None = None) -> Tally:
    """Check generated claims, judge every verdict, and return the counts.

    Parameters
    ----------
    count, seed : int
        The number of claims and the seed; a smaller number with the same seed gives the first of these claims.
    real : bool
        Claims of :mod:`tests.campaigns.checker.real_identities`.
    workers : int
        Processes.
    log : Path, optional
        File to which every answer is appended. Claims in the file are not checked again, unless their answers were
        wrong or late.

    Raises
    ------
    InputError
        If the log is that of another campaign.
    """
    known, tally = read_log(log), Tally()

    def rest() -> Iterator[tuple[int, Any]]:
        for place, claim in enumerate(real_claims(count, seed) if real else claims(count, seed), start=1):
            row = known.get(place)
            if row is not None and not row.claim.startswith(str(claim if real else claim[0])):
                raise InputError(
                    f"expected the log of the claims of seed {seed}; number {place} in {log} is another one"
                )
            if row is not None and not row.wrong and not row.late:
                tally.add(row)
            else:
                yield place, claim

    for row in judged_claims(partial(judged_real, seed) if real else judged, rest(), workers, log):
        tally.add(row)
        tally.show(count, row)
    return tally


def main(argv: Sequence[str] | None = None) -> int:
    """Run a campaign; the exit code is 1 if an answer is wrong, late or missing, or if too many are undecided.

    Of claims made by rewriting, 1 % may be undecided or, if true, refused; of claims about real functions, any number.
    """
    parser = ArgumentParser(prog="python -m tests.campaigns.checker.identities", description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=1000, help="claims (default: 1000)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--real", action="store_true", help="powers, logarithms, inverse functions and towers")
    parser.add_argument("--workers", type=int, default=1, metavar="N", help="processes (default: 1)")
    parser.add_argument("--log", type=Path, metavar="FILE", help="every answer, so that the same command goes on where "
                        "it was interrupted; wrong and late answers in it are asked for again")  # fmt: skip
    options = parser.parse_args(argv)
    try:
        tally = campaign(options.count, options.seed, options.real, options.workers, options.log)
    except InputError as reason:
        print(reason, file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        again = "; the same command goes on from there" if options.log else ", and nothing of it is saved without --log"
        print(f"interrupted{again}", file=sys.stderr)
        return 130
    for verdict, number_of in sorted(tally.counts.items()):
        print(f"{verdict:<26} {number_of}")
    undecided = sum(n for verdict, n in tally.counts.items() if verdict.endswith("undecided"))
    print(f"wrong {len(tally.wrong)}, late {len(tally.late)}, true and refused {len(tally.refused)}, "
          f"undecided {undecided} of {tally.count}")  # fmt: skip
    print(f"{tally.seconds:.1f} s, slowest claim {tally.slowest:.2f} s: {tally.slowest_claim}")
    for line in (*tally.wrong, *tally.late, *tally.refused)[:40]:
        print(line)
    too_open = not options.real and undecided + len(tally.refused) > MOST_OPEN * options.count
    return int(bool(tally.wrong or tally.late) or too_open)


if __name__ == "__main__":
    sys.exit(main())
