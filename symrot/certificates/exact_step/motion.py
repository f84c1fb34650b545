"""The proof that the C text of an exact step computes the motion: it solves the differential equations of the rates.

With the C text read as exact formulas F(x, dt), two equations are proven: F(x, 0) = x, and dF/d(dt) is the rates at F.
Their only solution is the motion. The two sides of each equation are compared at random points, modulo a prime. There,
a square root is a number with the right square, and sine and cosine of an angle are a point of the unit circle.
"""

from collections.abc import Callable, Mapping
from fractions import Fraction
from itertools import count
from typing import Any

from symrot.certificates.readback.operations import Operations
from symrot.certificates.residues import POINTS, PRIME, Residue, digest_number, exact, probability
from symrot.codegen.duals import Dual, dual_functions
from symrot.codegen.steps import SIZE
from symrot.errors import CertificateError
from symrot.formula.program import Program

__all__ = ["LAW", "motion_section", "require_limits"]

LAW = (
    "for dt = 0 the state is unchanged, and the derivative of the new state with respect to dt is the rates at the "
    "new state"
)
"""The law of an exact step, in the words of certificates."""
# a wrong formula with one square root holds at a random point where the root exists with a probability of at most
# 8 degree/PRIME
FACTOR = 8


class _NoRootError(ArithmeticError):
    """Raised for the square root of a number that has no square root modulo the prime ``PRIME`` = 2^127 - 1."""


def require_limits(file: str, operations: Operations) -> None:
    """Raise CertificateError if a C function has a conditional other than ``x == 0 ? 1 : sin(x)/x``.

    A random point tests only one branch of a conditional.
    """
    nodes = operations.nodes
    for node in nodes:
        if node[0] != "select":
            continue
        relation, x, zero, limit, quotient = node[1:]
        limits = relation == "==" and nodes[zero] == ("const", Fraction(0)) and nodes[limit] == ("const", Fraction(1))
        sine = nodes[nodes[quotient][1]] if limits and nodes[quotient][0] == "div" else None
        if sine != ("call", "sin", (x,)) or nodes[quotient][2] != x:
            raise CertificateError(
                f"{file}: expected no conditional expression in a step except x == 0 ? 1 : sin(x)/x, got another"
            )


def motion_section(file: str, rates: Program, places: Mapping[str, str], operations: Operations) -> dict[str, Any]:
    """Check that a C function computes the solution of the rates' equations; return the section ``motion``.

    The section of the certificate is a dict: ``law`` (for dt = 0 the state is unchanged, and the derivative of the new
    state with respect to dt is the rates at the new state), ``points`` (the number of random points of the check), and
    ``wrong_with_probability_below``: a bound of the probability that a C function which violates the law passes.

    Parameters
    ----------
    file : str
        Name of the C file, for messages.
    rates : Program
        The right-hand side ``dy = f(t, y, p)``.
    places : mapping
        The symbol of each input of the C function, such as ``"omega_1"`` for ``"x[0]"``.
    operations : Operations
        The C function.

    Raises
    ------
    CertificateError
        If the C function does not compute the motion.
    """
    degrees = [_degree(file, rates, places, operations, point) for point in range(POINTS)]
    return {"law": LAW, "points": POINTS, "wrong_with_probability_below": probability(max(degrees), FACTOR)}


def _degree(file: str, rates: Program, places: Mapping[str, str], operations: Operations, point: int) -> int:
    """Check at one random point that the C text F(x, dt) has F(x, 0) = x and dF/d(dt) = rates at F.

    Return a bound of the degree of the two equations, as rational functions of the inputs; it bounds the probability
    that wrong equations hold at the point. CertificateError is raised if an equation is violated.
    """
    for attempt in count():
        values = {
            symbol: Residue(digest_number(operations.digest(), "motion", point, attempt, symbol), 1)
            for symbol in places.values()
        }
        try:
            return _compared(file, rates, places, operations, values)
        except _NoRootError:  # of a random number, one of two is a square
            continue
    raise AssertionError


def _compared(
    file: str, rates: Program, places: Mapping[str, str], operations: Operations, values: Mapping[str, Residue]
) -> int:
    states = [name for name, *_ in rates.signature.argument("y").components]
    number = exact(operations.precision)
    start = _step(operations, places, dict(values) | {SIZE: Residue(0)})
    for name, result in zip(states, start, strict=True):
        if result.value.value != values[name].value:
            raise CertificateError(f"{file}: expected {name} to be unchanged by a step of size 0, got another value")
    after = _step(operations, places, values)
    there = dict(values) | {name: result.value for name, result in zip(states, after, strict=True)}
    slopes = rates.evaluate(there, _FUNCTIONS, number).values()
    degree = 0
    for name, result, slope in zip(states, after, slopes, strict=True):
        change, rate = Residue.of(result.slopes.get(SIZE, 0)), Residue.of(slope)
        if change.value != rate.value:
            raise CertificateError(
                f"{file}: expected the derivative of {name} with respect to the step length dt to be the rate that the "
                "equations of motion give, got another formula"
            )
        degree = max(degree, change.degree + rate.degree)
    return degree


def _step(operations: Operations, places: Mapping[str, str], values: Mapping[str, Residue]) -> list[Dual]:
    """Return the components of the state after a step, each with its derivative with respect to dt.

    ``places`` maps each input of the C function, such as ``"x[0]"``, to its symbol, such as ``"omega_1"``. ``values``
    maps each symbol, that of dt included, to its value: a residue, that is an integer modulo the prime ``PRIME``.
    """
    number = exact(operations.precision)
    inputs = {
        place: Dual(values[symbol], {SIZE: Residue(1)} if symbol == SIZE else {}) for place, symbol in places.items()
    }
    functions: dict[str, Callable[..., Any]] = dual_functions(_FUNCTIONS)
    functions["select"] = lambda relation, x, zero, limit, quotient: quotient if x.value.value else limit
    functions["div"] = lambda a, b: a / b if b.value.value else None  # sin(x)/x at x = 0, which no case selects
    try:
        results: list[Dual] = list(
            operations.evaluate(inputs, functions, lambda value: Dual(number(value), {})).values()
        )
        if None not in results:
            return results
    except (AttributeError, TypeError):  # of an operation with None
        pass
    raise CertificateError(f"{operations.name}: expected a step that is defined for dt = 0, but it divides by 0")


def _root(x: Any) -> Residue:
    square = Residue.of(x)
    root = pow(square.value, (PRIME + 1) // 4, PRIME)
    if root * root % PRIME != square.value:
        raise _NoRootError
    return Residue(root, square.degree)


def _circle(x: Any) -> tuple[Residue, Residue]:
    """Return cosine and sine of an angle as residues, that is integers modulo the prime ``PRIME``.

    They are 1 and 0 for the angle 0. For another angle they are a pseudo-random solution of c^2 + s^2 = 1 modulo the
    prime, the same for equal angles: equations that hold for every point of this circle hold for the angle's own
    cosine and sine.
    """
    angle = Residue.of(x)
    if not angle.value:
        return Residue(1), Residue(0)
    u = Residue(digest_number("circle", angle.value), 1)
    below = 1 + u * u
    return (1 - u * u) / below, 2 * u / below


def _unknown(name: str) -> Callable[..., Any]:
    def refuse(*arguments: Any) -> Any:
        raise CertificateError(f"expected only the functions sqrt, sin and cos in an exact step, got {name}")

    return refuse


_FUNCTIONS: dict[str, Callable[..., Any]] = {
    name: _unknown(name) for name in ("tan", "exp", "log", "sinh", "cosh", "tanh", "asin", "acos", "atan", "atan2")
} | {"sqrt": _root, "sin": lambda x: _circle(x)[1], "cos": lambda x: _circle(x)[0]}
