"""Kernels of a scene: programs and C code of its rates (time derivatives of the states) and other quantities."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from itertools import product

from sympy import Expr, Symbol

from symrot import symbols
from symrot.codegen.derivatives import Formulas, cheapest, ways
from symrot.codegen.lowering.lower import Lowered, lower
from symrot.codegen.printing.banner import CONTRACT, Description
from symrot.codegen.printing.c_function import c_function, c_name
from symrot.dynamics.equations import PLANAR_ANGLE, Equations, equations_of_motion
from symrot.dynamics.invariants import find_invariants
from symrot.dynamics.structure import Structure
from symrot.errors import InputError
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import text
from symrot.kernels.derivative import Derivatives
from symrot.kernels.jacobian import BY, jacobian_argument
from symrot.kinematics.quaternion import quaternion_to_dcm
from symrot.planning.scene_kernel import Conserved, Parameters, SceneKernel, bind

__all__ = [
    "corner_note",
    "derive_scene_kernel",
    "rate_derivatives",
    "rates_jacobian_program",
    "rates_program",
    "rates_source",
    "scene_description",
    "with_values",
]

MEANING = {
    **{f"omega_{i + 1}": "angular velocity, body components" for i in range(3)},
    **{f"q{i}": "attitude, body to space" for i in range(4)},
    **dict.fromkeys(("phi", "theta", "psi"), "Euler angles, in order of application"),
}
PLANAR_MEANING = "angle of rotation since the start"
RATES = "rates"  # the kernel of a compiled library; its function in C is symrot_rates
TIME = Argument("t", "in", (("t", "s", "time"),), is_scalar=True)


def _unit(symbol: Symbol) -> str:
    return "rad" if symbol == PLANAR_ANGLE else symbols.UNIT[symbol]


def _meaning(symbol: Symbol) -> str:
    return PLANAR_MEANING if symbol == PLANAR_ANGLE else MEANING[str(symbol)]


def _state_argument(equations: Equations) -> Argument:
    return Argument("y", "in", tuple((str(s), _unit(s), _meaning(s)) for s in equations.states))


def _rates_argument(equations: Equations) -> Argument:
    per_second = {"rad/s": "rad/s^2", "1": "1/s", "rad": "rad/s"}
    results = tuple((f"d{s}", per_second[_unit(s)], "time derivative of the state") for s in equations.states)
    return Argument("dy", "out", results)


def _rates(equations: Equations) -> Formulas:
    outputs = tuple((f"d{state}", rate) for state, rate in zip(equations.states, equations.rates, strict=True))
    return Formulas(outputs, equations.definitions)


def rates_program(equations: Equations, name: str) -> Lowered:
    """Return the program ``name`` of the rates dy(t, y, p) of equations of motion, with its parameters' formulas."""
    signature = Signature(name, (TIME, _state_argument(equations), _rates_argument(equations)))
    rates = _rates(equations)
    return lower(signature, rates.outputs, rates.named)


def rate_derivatives(equations: Equations, variables: Sequence[str]) -> tuple[Formulas, tuple[Argument, ...]]:
    """Return (formulas, output arrays) of the rates dy/dt of a scene and of their derivatives.

    The rates are differentiated with respect to ``variables``.

    Parameters
    ----------
    equations : Equations
        The equations of motion.
    variables : sequence of str
        ``"y"`` (all states), ``"omega"``, ``"q"`` or ``"angles"`` (some states), a single state, or a symbol in the
        equations: ``"t"`` or a physical constant.

    Returns
    -------
    (Formulas, tuple of Argument)
        The formulas by the chain rule. The output arrays are dy, then one array of derivatives per variable.

    Raises
    ------
    InputError
        If the equations contain no such state or symbol, or if one is named twice.
    """
    chosen = {name: _variables(equations, name) for name in variables}
    every = [symbol for symbols_ in chosen.values() for symbol in symbols_]
    if len(set(every)) < len(every) or len(chosen) < len(variables):
        raise InputError(
            f"expected each state and constant at most once among the variables {', '.join(variables)} with respect to "
            "which to differentiate; y stands for all states, omega and q for their components"
        )
    rates, target = _rates(equations), _rates_argument(equations)
    slopes, outputs, arguments = Derivatives(rates.named), list(rates.outputs), [target]
    for name, by in chosen.items():
        described = tuple((str(symbol), _unit_of_variable(symbol), "") for symbol in by)
        argument = jacobian_argument(target, name, described)
        entries = [slopes.of(rate, symbol) for rate, symbol in product(equations.rates, by)]
        outputs += zip((component for component, *_ in argument.components), entries, strict=True)
        arguments.append(argument)
    return Formulas(tuple(outputs), (*rates.named, *slopes.named.items())), tuple(arguments)


def rates_jacobian_program(
    equations: Equations, name: str, chained: Formulas, arguments: Sequence[Argument]
) -> Lowered:
    """Return the program, with the fewest operations, that computes the rates and their derivatives.

    ``chained`` (the formulas of the rates and of their derivatives, by the chain rule) and ``arguments`` (the output
    arrays) are the result of :func:`rate_derivatives`.
    """
    rates, states = _rates(equations), _state_argument(equations)
    held = {str(s) for _, formula in (*rates.outputs, *rates.named) for s in formula.free_symbols}
    inputs = {"t", *(str(state) for state in equations.states), *(str(symbol) for symbol, _ in rates.named)}
    constants = tuple((constant, "", "") for constant in sorted(held - inputs))
    free = Signature(name, (TIME, states, Argument("constants", "in", constants), _rates_argument(equations)))
    base = lower(free, rates.outputs, rates.named, "number_")
    ways_ = [chained]
    if not base.parameters:  # numbers such as pi are no inputs, so that only the chain rule applies
        entries = [(out, by) for out, mark, by in (each.partition(BY) for each, _ in chained.outputs) if mark]
        ways_ = list(ways(rates, chained, base.program, entries, [[str(state) for state in equations.states]]))
    return cheapest(Signature(name, (TIME, states, *arguments)), ways_)


def _variables(equations: Equations, name: str) -> tuple[Symbol, ...]:
    """Return the symbols that ``name`` stands for: one state, t or constant, or the states of a group.

    The groups are ``"y"`` (all states), ``"omega"``, ``"q"`` and ``"angles"``. Raise InputError if the equations
    contain no such symbol.
    """
    families = {"omega": symbols.omega_b, "q": symbols.quaternion, "angles": symbols.angles}
    states = [state for state in equations.states if name == "y" or state in families.get(name, ())]
    if states:
        return tuple(states)
    formulas = (*equations.rates, *(value for _, value in equations.definitions))
    defined = {symbol for symbol, _ in equations.definitions}
    held = {str(symbol): symbol for formula in formulas for symbol in formula.free_symbols - defined}
    held |= {str(state): state for state in equations.states}
    if name in held:
        return (held[name],)
    groups = [group for group, members in families.items() if set(members) & set(equations.states)]
    raise InputError(f"expected derivatives with respect to states or constants of the equations of motion "
                     f"({', '.join(['y', *groups, *sorted(held)])}), got {name!r}")  # fmt: skip


def _unit_of_variable(symbol: Symbol) -> str:
    return _unit(symbol) if symbol == PLANAR_ANGLE or symbol in symbols.UNIT else ""


def _quantities(equations: Equations, conserved: Mapping[str, Expr]) -> Lowered:
    outputs: list[tuple[str, str, Expr]] = [
        (f"omega_{i + 1} of t", "rad/s", omega) for i, omega in enumerate(equations.motion.omega_b)
    ]
    momentum = equations.momentum_b
    outputs += [(f"momentum_{i + 1}", "kg m^2/s", value) for i, value in enumerate(momentum)]
    outputs.append(("kinetic_energy", "J", equations.kinetic_energy))
    outputs.append(("energy", "J", equations.kinetic_energy + equations.potential))
    if equations.motion.quaternion is not None:
        outputs += [(f"q{i} of t", "1", q) for i, q in enumerate(equations.motion.quaternion)]
        momentum_s = quaternion_to_dcm(equations.motion.quaternion) * momentum
        outputs += [(f"momentum_{axis}", "kg m^2/s", value) for axis, value in zip("xyz", momentum_s, strict=True)]
    outputs += [(name, "", value) for name, value in conserved.items()]
    outputs += [(f"{mode} of t", "1", value) for mode, value in equations.modes]
    outputs += [(f"attraction {k} of t", "", value) for k, value in enumerate(equations.attraction)]
    results = Argument("out", "out", tuple((name, unit, "") for name, unit, _ in outputs))
    signature = Signature("quantities", (TIME, _state_argument(equations), results))
    return _lowered(signature, tuple([(name, value) for name, _, value in outputs]))


@lru_cache(maxsize=64)
def _lowered(signature: Signature, outputs: tuple[tuple[str, Expr], ...]) -> Lowered:
    """Return the program of output quantities; cached, since scenes with different torques often share it."""
    return lower(signature, outputs)


def derive_scene_kernel(
    structure: Structure, on_rates: Callable[[Program, str], object] = lambda rates, source: None
) -> SceneKernel:
    """Return the kernel of a scene: programs of the rates, of energy and momentum, and of conserved quantities.

    ``structure`` is the structure of the scene: its body, torques and states, and which of their constants are zero,
    equal or free, without the values of the free ones.

    ``on_rates`` is called with the program and the C text of the rates, before the other programs are derived.
    """
    equations = equations_of_motion(structure)
    rates = rates_program(equations, RATES)
    source = rates_source(rates)
    # a compiler can run while the rest is derived and proven
    on_rates(rates.program, source)
    invariants = find_invariants(equations, structure)
    conserved_values = {f"conserved_{i}": item.value for i, item in enumerate(invariants) if item.holds}
    quantities = _quantities(equations, conserved_values)
    conserved = tuple(
        Conserved(item.name, item.unit, f"conserved_{i}" if item.holds else "", item.holds, item.reason)
        for i, item in enumerate(invariants)
    )
    return SceneKernel.of(rates.program, rates.parameters, quantities.program, quantities.parameters, conserved, source)


def rates_source(rates: Lowered) -> str:
    """Return the C code of the rates: a function with the arguments ``(t, y, p, dy)``.

    The argument p is present even if the rates have no parameters.
    """
    source = c_function(rates.program, "static inline ")
    if rates.parameters:
        return source
    name = c_name(RATES)
    bare = source.replace(f" {name}(", f" {name}_bare(", 1)
    adapter = f"static inline void {name}(double t, const double *y, const double *p, double *dy)"
    return f"{bare}\n{adapter}\n{{\n    (void)p;\n    {name}_bare(t, y, dy);\n}}\n"


def with_values(program: Program, parameters: Parameters, constants: Mapping[str, Fraction]) -> Program:
    """Return a program that describes each parameter by its formula and value, such as ``(A - C)/A = 0.25``.

    The emitted head comment contains these texts.
    """
    values = bind(parameters, constants)
    described = tuple(
        (name, "", f"{text(formula)} = {value!r}") for (name, formula), value in zip(parameters, values, strict=True)
    )
    arguments = tuple(replace(a, components=described) if a.name == "p" else a for a in program.signature.arguments)
    return replace(program, signature=replace(program.signature, arguments=arguments))


def corner_note(program: Program, results: str) -> str:
    """Return a text that says where a program's derivatives are NaN (roots) or one-sided (absolute values).

    ``results`` names what the program computes, such as ``"the derivatives"``. The text begins with "; "; it is empty
    if the program calls neither ``sqrt`` nor ``copysign``.
    """
    calls = program.operations()
    return (calls["sqrt"] > 0) * f"; where a root of them is zero, {results} are NaN" + (
        calls["copysign"] > 0
    ) * "; at a kink, the derivatives are those of one side"


def scene_description(
    title: str,
    name: str,
    target: str,
    bounds: tuple[tuple[str, str], ...] = (),
    jacobian: Sequence[str] = (),
    exceptions: str = "",
) -> Description:
    """Return the texts for the head comment of a scene's kernel, a file in the language ``target``.

    ``bounds`` are pairs (heading, text) about rounding errors, used for C; ``jacobian`` are the states and constants
    with respect to which the kernel computes derivatives; ``exceptions`` is a text from :func:`corner_note`.
    """
    derivatives = f"; with their derivatives by {', '.join(jacobian)}, row by row" if jacobian else ""
    option = f" --jacobian {','.join(jacobian)}" if jacobian else ""
    return Description(
        title=f"equations of motion of the scene {name!r} ({title}){derivatives}",
        domain=f"all states of finite size{exceptions}; a quaternion is of unit norm, and its rate keeps the norm",
        derivation="derivations/euler_equations.md, derivations/quaternion_rates.md",
        command=f"symrot emit {name}{option} --target {target}",
        contract=(*bounds, *CONTRACT) if target == "c" else (),
    )
