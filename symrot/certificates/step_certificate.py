"""The certificate of an emitted time step: the C text computes the formula of a method, for any state and step size.

The formula, the method applied to the derived rates, is too long to expand. So C text and formula are computed at
random points, exactly, as residues: integers modulo a prime. Functions such as sin are random functions there.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction

from symrot.build.code_digest import text_digest
from symrot.certificates.certificate import Data, certificate_json
from symrot.certificates.exact_step.motion import motion_section, require_limits
from symrot.certificates.readback.c_functions import Parameter, functions_of
from symrot.certificates.readback.intended_constants import intended_value
from symrot.certificates.readback.operations import Operations
from symrot.certificates.readback.readback import read_batch, read_kernel
from symrot.certificates.residues import POINTS, RANDOM, Residue, digest_number, exact, probability
from symrot.certificates.rounding.output_graph import output_graph
from symrot.certificates.rounding.section import rounding_section
from symrot.certificates.truncation.bounds import truncation_bounds
from symrot.certificates.truncation.order import DEFECT
from symrot.codegen.steady_rotations import STATES
from symrot.codegen.steps import (
    SIZE,
    Method,
    RungeKutta,
    SteadyRotations,
    WithDerivatives,
    step_signature,
    stepped,
    without_factors,
)
from symrot.errors import CertificateError, InputError
from symrot.formula.exact_numbers import PI
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import Node, parse, text

__all__ = [
    "SCHEMA",
    "StepUnderTest",
    "bounds_of_step",
    "formula_section",
    "is_step",
    "rates_of",
    "rates_section",
    "step_certificate",
    "step_section",
    "trusted",
    "with_bounds",
]

SCHEMA = "symrot.step/2"
TYPES = {"": "double", "f": "float"}
TRUSTED = {
    "rates": "the formulas of the rates, which the certificate of the scene's own kernel proves",
    "C text": "that the compiler implements C correctly: real numbers are rounded to nearest, as IEEE 754 says",
}
ELLIPTIC = {
    "formula": "that equations which hold at the states to 15 digits hold at others: nothing is proven between them",
    "C text": TRUSTED["C text"],
}
ELLIPTIC_BOUNDS = {
    "arithmetic": "relative errors of sums of two doubles: 2^-102 of + - * / sqrt (proven in the sources that the C "
    "text names), 2^-90 of its functions dd_rf, dd_agm and dd_exp, apart from the errors of their arguments",
    "exact values": "ranges of the elliptic functions, modulus, quarter periods and phases; the theta series",
}
ELLIPTIC_NOT_STATED = {"not stated": "errors of rounding, and errors of truncation that do not show in 15 digits"}
WHOLE_STATE = {"rates": "the formulas of the rates, which symrot derives from Euler's equations for the whole state"}
NOT_STATED = {"not stated": "errors of rounding and truncation"}
EVALUATIONS = 32
"""Number of boxes evaluated per output to bound the rounding error of a step; more boxes hardly lower the bound."""


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


# The certificate states the rates, so that it can be audited without the scene. For a box of states and step sizes it
# may also bound the errors of one step: rounding (rounding/) and truncation (truncation/).
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
            "step": step_section(step.method),
            "rates": rates_section(step.rates, step.values),
            "files": {path: text_digest(text) for path, text in step.files.items()},
            "formula": formula_section(step.name, step.rates, step.method, step.files[f"{step.name}.c"]),
            "trusted": trusted(step.method.name, has_bounds=False),
        }
    )


def trusted(method: str, has_bounds: bool, elliptic: bool = False) -> Data:
    """Return the section ``trusted``: what the certificate of a step assumes, and which errors it does not state.

    ``elliptic`` says whether the step is an exact step with elliptic functions.
    """
    if elliptic:
        return ELLIPTIC | (ELLIPTIC_BOUNDS if has_bounds else ELLIPTIC_NOT_STATED)
    # the scene's own kernel leaves out constant states, which an exact step has
    assumptions = TRUSTED | (WHOLE_STATE if method == SteadyRotations.name else {})
    return assumptions if has_bounds else assumptions | NOT_STATED


def step_section(method: Method) -> Data:
    """Return the section ``step`` of a certificate: the name of the step's method, and the options of the method.

    The options of a numerical method are its order and, if it also computes derivatives, the inputs with respect to
    which the new state is differentiated. An exact step by steady rotations computes the closed form of a motion whose
    attitude is a product of rotations at constant rates. Its option is the body's symmetry axis, 1, 2 or 3, or None if
    omega is constant.
    """
    if isinstance(method, SteadyRotations):
        return {"method": method.name, "axis": None if method.axis is None else method.axis + 1}
    by = {"jacobian": list(method.by)} if isinstance(method, WithDerivatives) else {}
    return {"method": method.name, "order": method.order} | by


def is_step(data: object) -> bool:
    """Return whether ``data``, the content of a JSON file, is the certificate of a time step and not of a kernel."""
    return isinstance(data, dict) and str(data.get("schema", "")).startswith("symrot.step/")


def with_bounds(data: Data, bounds: Data) -> Data:
    """Return the content of a step's certificate with the section ``bounds``, which bounds the errors of one step.

    ``data`` is the content without these bounds. The section ``trusted``, the assumptions of the certificate, becomes
    that of a certificate with bounds. The result has no entry ``"seal"``, the hash of all other entries.
    """
    bare = {key: value for key, value in data.items() if key not in ("bounds", "trusted", "seal")}
    return bare | {"bounds": bounds, "trusted": trusted(data["step"]["method"], True, "scene" in data)}


def rates_section(rates: Program, values: Sequence[float]) -> Data:
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
            raise ValueError(f"{len(section['formulas'])} formulas for {len(states)} states")
        return Program(
            Signature(f"{data['kernel']}_rates", arguments),
            tuple((str(name), _folded(parse(formula))) for name, formula in section["temporaries"]),
            tuple((str(name), _folded(parse(formula))) for name, formula in section["formulas"]),
        )
    except (InputError, KeyError, TypeError, ValueError, AttributeError, ZeroDivisionError) as reason:
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
    """Return the section ``bounds`` of a step's certificate: bounds of the errors of rounding and truncation on a box.

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

    Raises
    ------
    InputError
        If an error has no bound on the box, or if a constant of the rates has the same double as a simpler number: the
        bounds would be proven for the simpler number.
    """
    _require_intended(rates)
    rounding = rounding_section(operations, None, box, budget=EVALUATIONS, fresh=fresh)
    symbols = _symbols_by_place(step_signature(rates, operations.name))
    used = {place for _, index in operations.outputs for place in output_graph(operations, index).places}
    ranges = {}
    for place, ends in rounding["box"].items():
        low, high = (Fraction(float.fromhex(end)) if place in used else Fraction(0) for end in ends)
        ranges[symbols[place]] = low, high
    errors = truncation_bounds(rates, _with_intended_constants(rates, method), ranges)
    return {
        "meaning": "for each state after one step from inputs in the box: |computed - exact motion| <= rounding + "
        "truncation, with the same floating-point initial state, step size and parameters",
        "truncation": {name: value.hex() for name, value in errors.items()},
        "rounding": rounding,
    }


def _require_intended(rates: Program) -> None:
    """Raise InputError if a constant of the rates has the same double as a simpler number.

    For example, the constant 0.3333333333333333 is refused. The C text contains its double, which is also the double of
    1/3, and the bounds are proven for 1/3. The constants 1/3 and 0.3 are accepted.
    """
    # the C text has the double alone, whose rounding error is bounded as that of the number for which it stands
    pending = [node for _, node in (*rates.temporaries, *rates.outputs)]
    while pending:
        node = pending.pop()
        pending += [part for part in (node[2] if node[0] == "call" else node[1:]) if isinstance(part, tuple)]
        own = _intended(node[1]) if node[0] == "number" else None
        if own is not None and abs(own - node[1]) > DEFECT * abs(own):
            meant = intended_value(Fraction(float(node[1])), "binary64")
            number = f"{meant.fraction}*pi" if meant.times_pi else str(meant.fraction)
            written = Decimal(node[1].numerator) / node[1].denominator
            raise InputError(
                f"{rates.signature.name}: expected the constant {number}, got {written}: both round to the same "
                f"double, and symrot proves the bounds for the simpler number; write {number}, or {written} with "
                "fewer digits"
            )


def _with_intended_constants(rates: Program, method: Method) -> Method:
    """Return a method whose coefficients are exact numbers, such as 1/3, instead of rounded decimals.

    The C text multiplies each coefficient by the leading factors of the rates and contains the rounded products. The
    exact coefficient is recovered from the exact number for which such a constant stands. A method without rounded
    coefficients is returned unchanged. CertificateError is raised if the constants of one coefficient stand for
    different values of it.
    """
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
                    f"{method.name}: expected the constants of the C text to stand for one value of the coefficient "
                    f"{float(value)!r}, got two values: {coefficient}, and {own / factor} from the constant "
                    f"{float(value * factor)!r} (the coefficient times {factor}), which stands for {own}; take "
                    "another method, or certify without ranges"
                )
        return coefficient

    return replace(
        method,
        nodes=tuple(map(exact, method.nodes)),
        stages=tuple({j: exact(a) for j, a in stage.items()} for stage in method.stages),
        weights={j: exact(b) for j, b in method.weights.items()},
    )


def _intended(value: Fraction) -> Fraction | None:
    """Return the exact number, such as 1/3, that a constant of the C text stands for; None if it stands for none.

    The constant is the double nearest to ``value``.
    """
    try:
        constant = intended_value(Fraction(float(value)), "binary64")
    except CertificateError:
        return None
    return constant.fraction * PI if constant.times_pi else constant.fraction


def _symbols_by_place(signature: Signature) -> dict[str, str]:
    """Return a map from each input component, such as ``"x[0]"``, to its symbol."""
    inputs = (a for a in signature.arguments if a.role == "in")
    return {place: component[0] for a in inputs for place, component in a.places.items()}


def formula_section(name: str, rates: Program, method: Method, source: str) -> Data:
    """Return the section ``formula`` of a step's certificate: the proof that each C function computes the method.

    Raises
    ------
    CertificateError
        If a C function computes another formula, or if the method is an exact step for other states than those of
        ``rates``.
    """
    if isinstance(method, SteadyRotations):
        states = [state for state, *_ in rates.signature.argument("y").components]
        slopes = [slope for slope, _ in rates.outputs]
        if states != list(STATES) or slopes != [f"d{state}" for state in STATES]:
            raise CertificateError(
                f"{name}: expected the rates of {', '.join(STATES)} for an exact step, got those of {', '.join(states)}"
            )
    return {f"symrot_{name}{suffix}": _proof(name, rates, method, source, suffix) for suffix in TYPES}


def _proof(step: str, rates: Program, method: Method, source: str, suffix: str) -> Data:
    file, name = f"{step}.c", f"symrot_{step}{suffix}"
    one = read_kernel(source, name, file)
    if one.digest() != read_batch(source, f"{name}_batch", file).digest():
        raise CertificateError(f"{file}: expected {name} and {name}_batch to perform the same operations, got others")
    by = method.by if isinstance(method, WithDerivatives) else ()
    _require_arguments(file, source, name, step_signature(rates, step, by), TYPES[suffix])
    require_limits(file, one)
    places = _symbols_by_place(step_signature(rates, step))
    degrees = [_degree(file, rates, method, places, one, point) for point in range(POINTS)]
    # the formula of a closed form must be the motion too
    motion = {"motion": motion_section(file, rates, places, one)} if isinstance(method, SteadyRotations) else {}
    return {"type": TYPES[suffix], "operations": one.counts(), "digest": one.digest(), "points": POINTS,
            "wrong_with_probability_below": probability(max(degrees))} | motion  # fmt: skip


def _require_arguments(file: str, source: str, name: str, signature: Signature, real: str) -> None:
    """Raise CertificateError unless the C functions of a step have the arguments and sizes that ``signature`` lists.

    There are two functions: ``name`` computes one sample, and ``{name}_batch`` n samples, with n as its first argument.
    """
    one, batch = [], [Parameter("n", "size_t", 0, False)]
    for each in signature.arguments:
        is_input = each.role == "in"
        one.append(Parameter(each.name, real, 0 if each.is_scalar else each.size, is_input and not each.is_scalar))
        batch.append(one[-1] if each.name == "p" else Parameter(each.name, real, -1, is_input))
    functions = functions_of(source, file)
    for function, expected in ((name, one), (f"{name}_batch", batch)):
        if functions[function].parameters != tuple(expected):
            right, wrong = (", ".join(map(_declaration, each)) for each in (expected, functions[function].parameters))
            raise CertificateError(f"{file}: expected {function} to have the arguments ({right}), got ({wrong})")


def _declaration(parameter: Parameter) -> str:
    """Return a parameter as C declares it, such as ``const double x[7]``."""
    size = "" if not parameter.size else "[]" if parameter.size < 0 else f"[{parameter.size}]"
    return f"{'const ' * parameter.is_const}{parameter.type} {parameter.name}{size}"


def _degree(
    file: str, rates: Program, method: Method, places: Mapping[str, str], operations: Operations, point: int
) -> int:
    """Compare the C function with the step's formula at one random point; return a bound of the outputs' degrees.

    The degrees, as rational functions of the inputs, are counted while the values are computed. ``places`` maps each
    input component, such as ``"x[0]"``, to its symbol. CertificateError is raised if an output differs at the point.
    """
    values = {symbol: Residue(digest_number(operations.digest(), point, symbol), 1) for symbol in places.values()}
    number = exact(operations.precision)
    computed = operations.evaluate({place: values[symbol] for place, symbol in places.items()}, RANDOM, number)
    formulas = stepped(rates, method, values, values[SIZE], RANDOM, number)
    for (place, ours), formula in zip(computed.items(), formulas, strict=True):
        if ours.value != Residue.of(formula).value:
            raise CertificateError(f"{file}: expected {place} to be the {method.formula}, got another formula")
    # the probability of a wrong proof follows from the degree as a rational function
    degrees: list[int] = [each.degree for each in (*computed.values(), *map(Residue.of, formulas))]
    return max(degrees)
