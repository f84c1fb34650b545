"""The certificate of an emitted time step: its C text computes the formula of its method, for any state and size.

The formula is the method applied to the derived rates. It has too many terms to be expanded, so C text and formula are
both computed at random points, exactly, in the field of integers modulo a prime. There, functions such as sin are
random functions. If the two differ as rational functions of degree d, they agree at a random point with a probability
of at most ``2 d/PRIME``. The points follow from the hash of the C text, so that the certificate is the same everywhere.

The certificate says nothing about rounding errors, and nothing about the truncation error but the order of the method.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from hashlib import sha256
from struct import pack, unpack
from typing import Any

from symrot.certificates.certificate import Data, certificate_json
from symrot.certificates.readback.intended_constants import intended_value
from symrot.certificates.readback.operations import Operations
from symrot.certificates.readback.readback import read_batch, read_kernel
from symrot.codegen.steps import Method, stepped
from symrot.errors import CertificateError
from symrot.formula.program import Program
from symrot.formula.tree import FUNCTIONS

__all__ = ["PRIME", "StepUnderTest", "step_certificate"]

PRIME = 2**127 - 1
POINTS = 4
TYPES = {"": "double", "f": "float"}
TRUSTED = {
    "rates": "the formulas of the rates, which the certificate of the scene's own kernel proves",
    "C text": "that the compiler gives C its meaning: real numbers are rounded as IEEE 754 says, to nearest",
    "not stated": "errors of rounding and truncation",
}


@dataclass(frozen=True)
class StepUnderTest:
    """A step to certify: its name and method, the rates of its scene, the command that prints it, and its files."""

    name: str
    title: str
    command: str
    rates: Program
    method: Method
    program: Program
    files: Mapping[str, str]


@dataclass(frozen=True)
class _Residue:
    """An integer modulo PRIME, with a bound of the degree of the rational function whose value it is."""

    value: int
    degree: int = 0

    @staticmethod
    def of(number: Any) -> "_Residue":
        if isinstance(number, _Residue):
            return number
        exact = Fraction(number)
        return _Residue(exact.numerator * pow(exact.denominator, -1, PRIME) % PRIME)

    def __add__(self, other: Any) -> "_Residue":
        right = _Residue.of(other)
        return _Residue((self.value + right.value) % PRIME, self.degree + right.degree)

    __radd__ = __add__

    def __neg__(self) -> "_Residue":
        return _Residue(-self.value % PRIME, self.degree)

    def __sub__(self, other: Any) -> "_Residue":
        return self + -_Residue.of(other)

    def __rsub__(self, other: Any) -> "_Residue":
        return _Residue.of(other) + -self

    def __mul__(self, other: Any) -> "_Residue":
        right = _Residue.of(other)
        return _Residue(self.value * right.value % PRIME, self.degree + right.degree)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "_Residue":
        right = _Residue.of(other)
        if not right.value:
            raise CertificateError("expected a point at which no divisor is zero, got another one")
        return self * _Residue(pow(right.value, -1, PRIME), right.degree)

    def __rtruediv__(self, other: Any) -> "_Residue":
        return _Residue.of(other) / self

    def __pow__(self, exponent: int) -> "_Residue":
        result = _Residue(1)
        for _ in range(abs(exponent)):
            result = result * self
        return result if exponent >= 0 else 1 / result


def _digest_number(*parts: object) -> int:
    return int.from_bytes(sha256(repr(parts).encode()).digest(), "big") % PRIME


def _function(name: str) -> Callable[..., _Residue]:
    """Return a function of residues whose values are random numbers that depend on its name and arguments alone."""
    return lambda *arguments: _Residue(_digest_number(name, *(_Residue.of(each).value for each in arguments)), 1)


_RANDOM = {name: _function(name) for name in (*FUNCTIONS, "copysign")}


def _exact(precision: str) -> Callable[[Fraction], _Residue]:
    """Return the meaning of a constant: the simple fraction that rounds to it, or else the rounded number itself."""

    def residue(value: Fraction) -> _Residue:
        rounded = float(value) if precision == "binary64" else float(unpack("f", pack("f", float(value)))[0])
        try:
            constant = intended_value(Fraction(rounded), precision)
        except CertificateError:
            return _Residue.of(Fraction(rounded))
        return _Residue.of(Fraction(rounded) if constant.times_pi else constant.fraction)

    return residue


def step_certificate(step: StepUnderTest) -> str:
    """Return the text of the certificate of a step.

    Raises
    ------
    CertificateError
        If the C text does not compute the formula of the method.
    """
    return certificate_json(
        {
            "schema": "symrot.step/1",
            "kernel": step.name,
            "title": step.title,
            "regenerate": step.command,
            "method": step.method.formula,
            "files": {path: sha256(text.encode()).hexdigest() for path, text in step.files.items()},
            "formula": {f"symrot_{step.name}{suffix}": _proof(step, suffix) for suffix in TYPES},
            "trusted": TRUSTED,
        }
    )


def _proof(step: StepUnderTest, suffix: str) -> Data:
    file = f"{step.name}.c"
    name, text = f"symrot_{step.name}{suffix}", step.files[file]
    one = read_kernel(text, name, file)
    if one.digest() != read_batch(text, f"{name}_batch", file).digest():
        raise CertificateError(f"{file}: expected {name} and {name}_batch to perform the same operations, got others")
    degrees = [_degree(step, one, point) for point in range(POINTS)]
    wrong = Fraction(2 * max(degrees), PRIME) ** POINTS
    power = wrong.denominator.bit_length() - wrong.numerator.bit_length() - 1
    return {"type": TYPES[suffix], "operations": one.counts(), "digest": one.digest(), "points": POINTS,
            "wrong_with_probability_below": f"2^-{power}"}  # fmt: skip


def _degree(step: StepUnderTest, operations: Operations, point: int) -> int:
    """Compare C text and formula at one random point; return the largest degree of an output as a rational function."""
    places = {
        (a.name if a.is_scalar else f"{a.name}[{i}]"): component[0]
        for a in step.program.signature.arguments
        if a.role == "in"
        for i, component in enumerate(a.components)
    }
    values = {symbol: _Residue(_digest_number(operations.digest(), point, symbol), 1) for symbol in places.values()}
    number = _exact(operations.precision)
    computed = operations.evaluate({place: values[symbol] for place, symbol in places.items()}, _RANDOM, number)
    exact = stepped(step.rates, step.method, values, values["dt"], _RANDOM, number)
    for (place, ours), formula in zip(computed.items(), exact, strict=True):
        if ours.value != _Residue.of(formula).value:
            raise CertificateError(
                f"{step.name}.c: expected {place} to be the {step.method.formula}, got another formula"
            )
    degrees: list[int] = [each.degree for each in (*computed.values(), *map(_Residue.of, exact))]
    return max(degrees)
