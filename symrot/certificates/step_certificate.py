"""The certificate of an emitted time step: the C text computes the formula of a method, for any state and step size.

The formula, the method applied to the derived rates, is too long to expand. So C text and formula are computed at
random points, exactly, as residues: integers modulo a prime. Functions such as sin are random functions there.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from hashlib import sha256
from struct import pack, unpack
from typing import Any

from symrot.certificates.certificate import Data, certificate_json
from symrot.certificates.readback.intended_constants import intended_value
from symrot.certificates.readback.operations import Operations
from symrot.certificates.readback.readback import read_batch, read_kernel
from symrot.certificates.rounding.bounds import rounding_section
from symrot.certificates.rounding.scenes import ANY
from symrot.certificates.truncation import DEFECT, truncation_bounds
from symrot.codegen.steps import (
    SIZE,
    Method,
    RungeKutta,
    WithDerivatives,
    step_signature,
    stepped,
    without_factors,
)
from symrot.errors import CertificateError, InputError
from symrot.formula.exact_numbers import PI
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import FUNCTIONS, Node, parse, text

__all__ = [
    "PRIME",
    "SCHEMA",
    "StepUnderTest",
    "bounds_of_step",
    "formula_section",
    "is_step",
    "rates_of",
    "step_certificate",
    "with_bounds",
]

SCHEMA = "symrot.step/2"
PRIME = 2**127 - 1
POINTS = 4
TYPES = {"": "double", "f": "float"}
TRUSTED = {
    "rates": "the formulas of the rates, which the certificate of the scene's own kernel proves",
    "C text": "that the compiler gives C its meaning: real numbers are rounded as IEEE 754 says, to nearest",
}
NOT_STATED = {"not stated": "errors of rounding and truncation"}
EVALUATIONS = 32
"""Boxes that the search for a bound of rounding errors evaluates per output; more hardly lower the bound of a step."""


@dataclass(frozen=True)
class StepUnderTest:
    """A step to certify: its name and method, the rates of its scene, the command that prints it, and its files."""

    name: str
    title: str
    command: str
    rates: Program
    method: Method
    values: tuple[float, ...]  # of the parameters of the rates
    files: Mapping[str, str]


# Two rational functions of degree d that differ agree at a random point with a probability of at most 2 d/PRIME. The
# points follow from the hash of the C text, so that the certificate is the same everywhere. The certificate states the
# rates, so that it can be audited without the scene. For a box of states and step sizes it may also bound the errors of
# one step: rounding (rounding/) and truncation (truncation.py).
@dataclass(frozen=True)
class _Residue:
    """The value, modulo PRIME, of a rational function at a random point, with a bound of the function's degree."""

    value: int
    # the larger, the more probable it is that two different functions agree at the point
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
            raise CertificateError("expected a point at which no divisor is zero, got a point with a zero divisor")
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
    """Return a random function of residues (numbers modulo PRIME) that stands for a function such as sine."""
    # the value depends on name and arguments alone, so that equal calls have equal values
    return lambda *arguments: _Residue(_digest_number(name, *(_Residue.of(each).value for each in arguments)), 1)


_RANDOM = {name: _function(name) for name in (*FUNCTIONS, "copysign")}


def _exact(precision: str) -> Callable[[Fraction], _Residue]:
    """Return a function that converts a rounded constant of the C text to a residue, its value modulo PRIME."""

    def residue(value: Fraction) -> _Residue:
        rounded = float(value) if precision == "binary64" else float(unpack("f", pack("f", float(value)))[0])
        try:
            constant = intended_value(Fraction(rounded), precision)
        except CertificateError:
            return _Residue.of(Fraction(rounded))
        # the value of the simple fraction that rounds to the constant, such as 1/3, if there is one
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
            "schema": SCHEMA,
            "kernel": step.name,
            "title": step.title,
            "regenerate": step.command,
            "method": step.method.formula,
            "step": {"method": step.method.name, "order": step.method.order} | _derivatives(step.method),
            "rates": _rates_section(step.rates, step.values),
            "files": {path: sha256(text.encode()).hexdigest() for path, text in step.files.items()},
            "formula": formula_section(step.name, step.rates, step.method, step.files[f"{step.name}.c"]),
            "trusted": TRUSTED | NOT_STATED,
        }
    )


def _derivatives(method: Method) -> Data:
    """Return the names of the inputs by which a step's formula is differentiated; empty without derivatives."""
    return {"jacobian": list(method.by)} if isinstance(method, WithDerivatives) else {}


def is_step(data: object) -> bool:
    """Return whether ``data``, the content of a JSON file, is the certificate of a time step and not of a kernel."""
    return isinstance(data, dict) and str(data.get("schema", "")).startswith("symrot.step/")


def with_bounds(data: Data, bounds: Data) -> Data:
    """Return the certificate ``data`` of a step with one more section: ``bounds`` of the errors of one step."""
    bare = {key: value for key, value in data.items() if key not in ("bounds", "trusted", "seal")}
    return bare | {"bounds": bounds, "trusted": TRUSTED}


def _rates_section(rates: Program, values: Sequence[float]) -> Data:
    """Return the rates ``dy/dt`` of a motion as data for JSON: formulas as text, parameters with their ``values``."""
    parameters = [c for a in rates.signature.arguments if a.name == "p" for c in a.components]
    return {
        "states": [list(component[:2]) for component in rates.signature.argument("y").components],
        "parameters": [
            [name, meaning, value.hex()] for (name, _, meaning), value in zip(parameters, values, strict=True)
        ],
        "temporaries": [[name, text(node)] for name, node in rates.temporaries],
        "formulas": [[name, text(node)] for name, node in rates.outputs],
    }  # fmt: skip


def rates_of(data: Data) -> Program:
    """Return the rates ``dy/dt`` that the certificate ``data`` of a step states, as a program.

    Raises
    ------
    CertificateError
        If the section ``rates`` of the certificate is missing or not in the form in which symrot prints it.
    """
    try:
        section = data["rates"]
        states = tuple((name, unit, "") for name, unit in section["states"])
        parameters = tuple((name, "", meaning) for name, meaning, value in section["parameters"])
        arguments = (
            Argument("t", "in", (("t", "s", "time"),), is_scalar=True), Argument("y", "in", states),
            Argument("p", "in", parameters),
            Argument("dy", "out", tuple((name, "", "") for name, _ in section["formulas"])),
        )  # fmt: skip
        if len(states) != len(section["formulas"]):
            raise ValueError("as many formulas as states")
        return Program(
            Signature(f"{data['kernel']}_rates", arguments),
            tuple((str(name), _folded(parse(formula))) for name, formula in section["temporaries"]),
            tuple((str(name), _folded(parse(formula))) for name, formula in section["formulas"]),
        )
    except (InputError, KeyError, TypeError, ValueError, AttributeError) as reason:
        raise CertificateError(
            f"expected 'rates' in the certificate as symrot prints them, got other content ({reason})"
        ) from None


def _folded(node: Node) -> Node:
    """Return a formula in which each quotient of two numbers, such as 1 / 3, is one number, the fraction 1/3."""
    if node[0] == "call":
        return ("call", node[1], tuple(map(_folded, node[2])))
    if node[0] in ("number", "symbol"):
        return node
    if node[0] == "**":
        return ("**", _folded(node[1]), node[2])
    parts = tuple(map(_folded, node[1:]))
    if node[0] in ("neg", "/") and all(part[0] == "number" for part in parts):
        values = [part[1] for part in parts]
        return ("number", -values[0] if node[0] == "neg" else values[0] / values[1])
    return (node[0], *parts)


def bounds_of_step(
    operations: Operations, rates: Program, method: Method, box: Mapping[str, tuple[Fraction, Fraction]],
    fresh: bool = False,
) -> Data:  # fmt: skip
    """Return the section ``bounds`` of the certificate of a step: rounding and truncation on a box.

    Parameters
    ----------
    operations : Operations
        The operations of the C function in double precision.
    rates : Program
        The rates, as :func:`rates_of` reads them.
    method : Method
        The method of the step.
    box : mapping
        Ranges of the inputs by their places, such as ``"x[0]"`` and ``"dt"``.
    fresh : bool
        Whether to compute bounds of rounding errors even if the user's cache has them.
    """
    rounding = rounding_section(operations, None, box, budget=EVALUATIONS, fresh=fresh)
    symbols = _symbols_by_place(step_signature(rates, operations.name))
    ranges = {}
    for place, ends in rounding["box"].items():
        low, high = (Fraction(float.fromhex(end)) for end in ends)
        ranges[symbols[place]] = (low, high) if (low, high) != ANY else (Fraction(0), Fraction(0))  # it is not used
    errors = truncation_bounds(rates, _with_intended_constants(rates, method), ranges)
    return {
        "meaning": "for each state after one step on the box: |computed - exact motion| <= rounding + truncation, from "
        "the same floating-point start, size and parameters",
        "truncation": {name: value.hex() for name, value in errors.items()},
        "rounding": rounding,
    }


def _with_intended_constants(rates: Program, method: Method) -> Method:
    """Return a method with the exact coefficients, such as 1/3, for which the constants of the C text stand."""
    if not isinstance(method, RungeKutta) or not method.rounded:
        return method
    factors = [abs(factor) for factor in dict.fromkeys(without_factors(rates)[1])]

    # rounding errors are bounded from these exact numbers; a constant that stands for another number is refused
    def exact(value: Fraction) -> Fraction:
        fractions = [(_intended(value * factor), factor) for factor in factors]
        near = [own / factor for own, factor in fractions if own is not None and abs(own / factor - value) < DEFECT]
        coefficient = near[0] if near else value
        for own, factor in fractions:
            if own is not None and own != coefficient * factor:
                raise CertificateError(
                    f"{method.name}: expected the constant {float(value * factor)!r} in the C text to stand for "
                    f"{factor} times the coefficient {float(value)!r}, got one that stands for {own}"
                )
        return coefficient

    return replace(
        method,
        nodes=tuple(map(exact, method.nodes)),
        stages=tuple({j: exact(a) for j, a in stage.items()} for stage in method.stages),
        weights={j: exact(b) for j, b in method.weights.items()},
    )


def _intended(value: Fraction) -> Fraction | None:
    """Return the exact number, such as 1/3, for which ``value`` rounded to a double stands; None if there is none."""
    try:
        constant = intended_value(Fraction(float(value)), "binary64")
    except CertificateError:
        return None
    return constant.fraction * PI if constant.times_pi else constant.fraction


def _symbols_by_place(signature: Signature) -> dict[str, str]:
    """Return a map from each input component, such as ``"x[0]"``, to its symbol."""
    return {
        (a.name if a.is_scalar else f"{a.name}[{i}]"): component[0]
        for a in signature.arguments
        if a.role == "in"
        for i, component in enumerate(a.components)
    }


def formula_section(name: str, rates: Program, method: Method, source: str) -> Data:
    """Return the section ``formula`` of a step's certificate: the proof that each C function computes the method.

    Raises
    ------
    CertificateError
        If a C function computes another formula.
    """
    return {f"symrot_{name}{suffix}": _proof(name, rates, method, source, suffix) for suffix in TYPES}


def _proof(step: str, rates: Program, method: Method, source: str, suffix: str) -> Data:
    file, name = f"{step}.c", f"symrot_{step}{suffix}"
    one = read_kernel(source, name, file)
    if one.digest() != read_batch(source, f"{name}_batch", file).digest():
        raise CertificateError(f"{file}: expected {name} and {name}_batch to perform the same operations, got others")
    places = _symbols_by_place(step_signature(rates, step))
    degrees = [_degree(file, rates, method, places, one, point) for point in range(POINTS)]
    wrong = Fraction(2 * max(degrees), PRIME) ** POINTS
    power = wrong.denominator.bit_length() - wrong.numerator.bit_length() - 1
    return {"type": TYPES[suffix], "operations": one.counts(), "digest": one.digest(), "points": POINTS,
            "wrong_with_probability_below": f"2^-{power}"}  # fmt: skip


def _degree(
    file: str, rates: Program, method: Method, places: Mapping[str, str], operations: Operations, point: int
) -> int:
    """Return a bound of the degrees of the outputs, as rational functions of the inputs, computed at a random point.

    CertificateError is raised if an output of the C text differs there from the step's formula.
    """
    values = {symbol: _Residue(_digest_number(operations.digest(), point, symbol), 1) for symbol in places.values()}
    number = _exact(operations.precision)
    computed = operations.evaluate({place: values[symbol] for place, symbol in places.items()}, _RANDOM, number)
    exact = stepped(rates, method, values, values[SIZE], _RANDOM, number)
    for (place, ours), formula in zip(computed.items(), exact, strict=True):
        if ours.value != _Residue.of(formula).value:
            raise CertificateError(f"{file}: expected {place} to be the {method.formula}, got another formula")
    # the probability of a wrong proof follows from the degree as a rational function
    degrees: list[int] = [each.degree for each in (*computed.values(), *map(_Residue.of, exact))]
    return max(degrees)
