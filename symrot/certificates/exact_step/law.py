"""The check that the C text of an exact step with elliptic functions solves the equations of motion, to 15 digits.

The text has loops over arithmetic-geometric means and series, so there is no finite formula to compare. It is read as a
program on real numbers and run with 60 digits: F(x, 0) must be x, and dF/d(dt) must be the rates at F, at pseudo-random
states x, seeded by the hash of the text. So constants, signs, series and where they end are checked; rounding is not.
"""

from collections.abc import Callable, Mapping, Sequence
from decimal import ROUND_HALF_EVEN, Context, Decimal, localcontext
from fractions import Fraction
from functools import lru_cache
from hashlib import sha256
from math import copysign, frexp
from typing import Any

from symrot.certificates.c_machine.machine import Machine
from symrot.certificates.c_machine.values import Place
from symrot.certificates.exact_step.motion import LAW
from symrot.errors import CertificateError
from symrot.formula.exact_numbers import PI
from symrot.formula.program import Program

__all__ = ["DIGITS", "STATES", "law_section"]

DIGITS = 15
"""Decimal digits to which the C text of a step must obey the two checked equations at each tested state x.

With F(x, dt) for the state after a step of size dt, they are F(x, 0) = x and dF/d(dt) = (the rates at F)."""
LIMIT = Decimal(10) ** -DIGITS
PRECISION = 60  # digits of the numbers
STATES = 12
"""Number of states at which the equations are checked: three with any omega, nine with omega near a body axis."""
_TERMS = 60  # of the series of sine and cosine, together, for angles of at most pi/4

_State = tuple[list[Decimal], Decimal]


class _Slope:
    """A number that depends on dt, with its derivative with respect to dt."""

    __slots__ = ("slope", "value")

    def __init__(self, value: Decimal, slope: Decimal) -> None:
        self.value, self.slope = value, slope

    def __add__(self, other: Any) -> "_Slope":
        right = _slope(other)
        return _Slope(self.value + right.value, self.slope + right.slope)

    __radd__ = __add__

    def __neg__(self) -> "_Slope":
        return _Slope(-self.value, -self.slope)

    def __sub__(self, other: Any) -> "_Slope":
        right = _slope(other)
        return _Slope(self.value - right.value, self.slope - right.slope)

    def __rsub__(self, other: Any) -> "_Slope":
        return _slope(other) - self

    def __mul__(self, other: Any) -> "_Slope":
        right = _slope(other)
        return _Slope(self.value * right.value, self.slope * right.value + self.value * right.slope)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "_Slope":
        right = _slope(other)
        value = self.value / right.value
        return _Slope(value, (self.slope - value * right.slope) / right.value)

    def __rtruediv__(self, other: Any) -> "_Slope":
        return _slope(other) / self

    def __abs__(self) -> "_Slope":
        return -self if self.value < 0 else self

    def __eq__(self, other: object) -> bool:
        return self.value == _slope(other).value

    __hash__ = None  # type: ignore[assignment]

    def __lt__(self, other: Any) -> bool:
        return self.value < _slope(other).value

    def __gt__(self, other: Any) -> bool:
        return self.value > _slope(other).value

    def __le__(self, other: Any) -> bool:
        return self.value <= _slope(other).value

    def __ge__(self, other: Any) -> bool:
        return self.value >= _slope(other).value

    def __int__(self) -> int:
        return int(self.value)

    def __float__(self) -> float:
        return float(self.value)


def _slope(value: Any) -> _Slope:
    return value if isinstance(value, _Slope) else _Slope(value, Decimal(0))


def _number(value: Fraction) -> Decimal:
    return Decimal(value.numerator) / value.denominator


# --- functions of the C text that are computed with all digits --------------------------------------------------------


def _rint(x: Any) -> Decimal:
    """Return the whole number nearest to ``x``, as a Decimal.

    ``x`` is a Decimal or a _Slope, a value with its derivative with respect to the step size. The derivative of the
    result is zero.
    """
    return _slope(x).value.to_integral_value(ROUND_HALF_EVEN)


def _sqrt(x: Any) -> Any:
    if not isinstance(x, _Slope):
        return x.sqrt()
    root = x.value.sqrt()
    return _Slope(root, x.slope / (2 * root))


def _exp(x: Any) -> Any:
    if not isinstance(x, _Slope):
        return x.exp()
    value = x.value.exp()
    return _Slope(value, value * x.slope)


def _sincos_quarters(rest: Any, quarters: Any, sine: Place, cosine: Place) -> None:
    """Store sine and cosine of ``rest + quarters/4`` revolutions; ``quarters`` is a whole number."""
    turns = _slope(rest)
    pi = _number(PI)
    x = 2 * pi * turns.value
    s, c, term = Decimal(0), Decimal(0), Decimal(1)
    for n in range(1, _TERMS):  # x^n/n! with the signs +, +, -, -
        c += term if n % 2 else 0
        s += 0 if n % 2 else term
        term = term * x / n * (1 if n % 2 else -1)
    for _ in range(int(_slope(quarters).value) % 4):
        s, c = c, -s
    factor = 2 * pi * turns.slope
    sine[0][sine[1]] = _Slope(s, c * factor)
    cosine[0][cosine[1]] = _Slope(c, -s * factor)


def _frexp(x: Any, exponent: Place) -> Any:
    exponent[0][exponent[1]] = frexp(float(x))[1]
    return x


def _memcpy(to: Place, start: Place, size: int) -> None:
    for k in range(size // 8):
        to[0][to[1] + k] = start[0][start[1] + k]


# name -> letters of the types of result and arguments (r: real, i: whole, p: pointer, v: none), and the function
_OWN: Mapping[str, tuple[str, Callable[..., Any]]] = {
    "fabs": ("rr", abs), "rint": ("rr", _rint), "sqrt": ("rr", _sqrt), "fmax": ("rrr", max),
    # the start of an iteration
    "cbrt": ("rr", lambda x: Decimal(copysign(abs(float(x)) ** (1 / 3), float(x)))),
    "frexp": ("rrp", _frexp), "ldexp": ("rri", lambda x, power: x * Decimal(2) ** power),
    "memcpy": ("vppi", _memcpy),
    # the C function tests that the processor rounds every operation
    "dd_sound": ("i", lambda: 1),
    # polynomials in double precision, accurate to 1e-17
    "sincos_quarters": ("vrrpp", _sincos_quarters), "exp_moderate": ("rr", _exp),
}  # fmt: skip


# --- the law ----------------------------------------------------------------------------------------------------------


def _states(source: str, omega_scale: Fraction) -> list[_State]:
    """Return pseudo-random pairs (state, size dt of a step), seeded by the hash of a C text.

    A state is omega and a quaternion. The components of omega are at most 1.25*omega_scale, in rad/s; dt is between
    0.25/omega_scale and 2.25/omega_scale.
    """
    states = []
    for k in range(STATES):
        a, b, c, d, *four = sha256(f"{k} {source}".encode()).digest()[:8]
        omega = [Fraction(2 * x - 255 or 1, 256) for x in (a, b, c)]
        if k % 4:  # near a body axis
            omega = [w / 16 if i != k % 4 - 1 else 1 + w / 4 for i, w in enumerate(omega)]
        p = [x + 1 for x in four]
        # the square of a quaternion with whole components has a whole norm
        norm = sum(x * x for x in p)
        q = [p[0] * p[0] - sum(x * x for x in p[1:]), *(2 * p[0] * x for x in p[1:])]
        scale = _number(omega_scale)
        dt = Decimal(d + 32) / 128 / scale
        states.append(([*(_number(w) * scale for w in omega), *(Decimal(x) / norm for x in q)], dt))
    return states


def law_section(
    source: str, name: str, rates: Program, values: Mapping[str, Fraction], parameters: Sequence[Fraction],
    omega_scale: Fraction, count: int = STATES,
) -> dict[str, Any]:  # fmt: skip
    """Check at some states that a C function computes the motion; return this check as data for the certificate.

    The motion is the solution of the rates' differential equations: a step of size 0 must change nothing, and the
    derivative with respect to dt of the state after a step must be the rates at this state. The result is a dict:
    ``law`` (these two equations in words), ``states`` (their number), ``digits``, ``largest_violation`` (relative, as
    text). The last 16 results are cached.

    Parameters
    ----------
    source : str
        The C text of the step.
    name : str
        The name of its function.
    rates : Program
        The rates of omega and of the quaternion.
    values : mapping
        The exact values of the parameters of ``rates``.
    parameters : sequence of Fraction
        The parameters p of the step.
    omega_scale : Fraction
        The size of the angular velocities at which the law is checked, rad/s.
    count : int
        The number of states, at most ``STATES``.

    Raises
    ------
    CertificateError
        If the C text violates the law, or is no C that symrot emits.
    """
    return dict(_law(source, name, rates, tuple(values.items()), tuple(parameters), omega_scale, count))


@lru_cache(maxsize=16)
def _law(
    source: str, name: str, rates: Program, values: tuple[tuple[str, Fraction], ...],
    parameters: tuple[Fraction, ...], omega_scale: Fraction, count: int,
) -> dict[str, Any]:  # fmt: skip
    machine = Machine(source, _number, _OWN)
    with localcontext(Context(prec=PRECISION)):
        p = [_number(x) for x in parameters]
        constants = {symbol: _number(value) for symbol, value in values} | {"t": Decimal(0)}
        worst = Decimal(0)
        for state, dt in _states(source, omega_scale)[:count]:
            worst = max(worst, _violation(machine, name, rates, constants, p, state, dt, _number(omega_scale)))
        return {"law": LAW, "states": count, "digits": DIGITS, "largest_violation": f"{worst:.0e}"}


def _violation(
    machine: Machine, name: str, rates: Program, constants: Mapping[str, Decimal], p: list[Decimal],
    state: list[Decimal], dt: Decimal, omega_scale: Decimal,
) -> Decimal:  # fmt: skip
    """Return the largest relative error of the two equations F(x, 0) = x and dF/d(dt) = f(F), for one state and ``dt``.

    F(x, dt) is the state after a step that the C function ``name`` computes, and f are the rates. ``p`` are the
    parameters that the C function takes; ``constants`` maps the symbols in the formulas of the rates, other than the
    state, to their values. Errors of omega are relative to the larger of ``omega_scale`` and the largest component of
    omega, both in rad/s. CertificateError is raised if an error is 10^-DIGITS or more, or if the C function rejects the
    state.
    """
    states = [component[0] for component in rates.signature.argument("y").components]
    scale = max(omega_scale, *map(abs, state[:3]))

    def after(size: _Slope) -> list[_Slope]:
        result: list[Any] = [Decimal(0)] * len(states)
        if machine.call(name, Decimal(0), (list(state), 0), (list(p), 0), size, (result, 0)):
            raise CertificateError(f"{name}: expected the step to accept a state in its domain, got an error code")
        return [_slope(each) for each in result]

    worst = Decimal(0)
    for symbol, before, start in zip(states, state, after(_Slope(Decimal(0), Decimal(0))), strict=True):
        worst = max(worst, off := abs(start.value - before) / (scale if symbol.startswith("omega") else 1))
        if not off < LIMIT:
            raise CertificateError(f"{name}: expected {symbol} to be unchanged by a step of size 0, got another value")
    ends = after(_Slope(dt, Decimal(1)))
    there = dict(constants) | {symbol: end.value for symbol, end in zip(states, ends, strict=True)}
    for symbol, end, rate in zip(states, ends, rates.evaluate(there, {}, _number).values(), strict=True):
        worst = max(worst, off := abs(end.slope - rate) / (scale * scale if symbol.startswith("omega") else scale))
        if not off < LIMIT:  # a number that is not finite is below no limit
            raise CertificateError(
                f"{name}: expected the derivative of {symbol} with respect to the step length dt to be the rate "
                f"{float(rate):.9g} that the equations of motion give, got {float(end.slope):.9g}"
            )
    return worst
