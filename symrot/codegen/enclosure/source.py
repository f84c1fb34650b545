"""C code that bounds how far the rates dy/dt deviate from constants near a step, so that no step misses a pulse.

A pulse is a short change of the rates, such as a torque exp(-(t - 5)^2). The bounds hold on discs of complex times and
states; :file:`propagation/enclosures/disc.h` contains the rules of disc arithmetic. Standard library only.
"""

from collections.abc import Mapping, Sequence

from symrot.codegen.enclosure.terms import (
    LOW_ORDER,
    REACHES,
    Enclosure,
    enclosure,
    functions_of_time,
    rounded_terms,
    value_operands,
)
from symrot.codegen.printing.c_function import c_expression
from symrot.codegen.taylor.recurrences import Recurrences, recurrences
from symrot.errors import InputError
from symrot.formula.program import Program
from symrot.formula.tree import Node, rename

__all__ = ["enclosure_definitions", "enclosure_source", "rounding_source"]


def enclosure_source(program: Program, order: int, edges: Sequence[int]) -> str:
    """Return C code that bounds a program's rates on complex discs, so that a stepper notices pulses within a step.

    See :func:`enclosure_definitions` for the arguments.
    """
    try:
        return enclosure_definitions(enclosure(recurrences(program)), order, edges)
    # rates without a Taylor series, such as rates with abs: code without bounds
    except InputError:
        return enclosure_definitions(None, order, edges)


def enclosure_definitions(enclosure: Enclosure | None, order: int, edges: Sequence[int]) -> str:
    """Return the C code of an enclosure: the function ``symrot_deviations``, which bounds the rates, and tables for it.

    Parameters
    ----------
    enclosure : Enclosure or None
        The terms of the rates in which a step may miss a pulse, such as exp(-(t - 5)^2); None if there are none.
    order : int
        The order N of the Taylor polynomials that approximate the states in a step.
    edges : sequence of int
        State i is in block j if ``edges[j] <= i < edges[j + 1]``; each block of states has its own error.

    Notes
    -----
    The C code bounds the terms' deviation from constants by D, on a disc of complex times whose radius is r times
    the step h. Then the step has an error of at most ``h D r^-N/((N + 1)(1 - 1/r))``. The C table ``symrot_reaches``
    holds the numbers r that the stepper tries, each with the factor of h D.
    """
    if enclosure is None:
        return "#define SYMROT_ENCLOSED 0\n#define SYMROT_DEPENDS 0\n"
    system = enclosure.system
    places = {name: f"p[{i}]" for i, name in enumerate(system.parameters)}
    lines = [f"const symrot_disc d{i} = {_disc(system, i, places)};" for i in enclosure.series]
    lines += _radii(enclosure, places)
    used = ", ".join("1" if state in enclosure.states else "0" for state in range(len(system.states)))
    radii = REACHES[order < LOW_ORDER]
    reaches = ", ".join(f"{{{r!r}, {r**-order / ((order + 1) * (1 - 1 / r))!r}}}" for r in radii)
    return "\n".join([
        "#define SYMROT_ENCLOSED 1",
        f"#define SYMROT_DEPENDS {int(bool(enclosure.states))}",
        f"#define SYMROT_ENCLOSED_ORDER {order}",
        f"#define SYMROT_REACHES {len(radii)}",
        f"#define SYMROT_BORDERS {len(edges) - 1}",
        f"static const int symrot_borders[] = {{{', '.join(map(str, edges))}}};",
        f"static const double symrot_reaches[][2] = {{{reaches}}};  /* in steps; the share of a deviation missed */",
        f"static const int symrot_encloses[] = {{{used}}};  /* whether the enclosed terms depend on a state */",
        "",
        "/* Bound how far the enclosed terms of each rate deviate from a constant for times within `reach` of t and",
        " * states within `radius` of y; `whole` is for roots, see symrot_disc_sqrt. */",
        "static void symrot_deviations(double t, double reach, double whole, const double *y, const double *radius,",
        "    const double *p, double *deviation)",
        "{",
        *(f"    (void){name};" for name in ("t", "reach", "whole", "y", "radius", "p")),
        *(f"    {line}" for line in lines),
        "}",
        "",
    ])  # fmt: skip


def rounding_source(program: Program) -> str:
    """Return C code that bounds the errors that a program's rates have because formulas of t in them are rounded.

    For example, the rounding of the phase ``t**2 - 25`` deforms the narrow pulse ``w/((t**2 - 25)**2 + w**2)``. If such
    errors may be large, the code defines the function ``symrot_roundings``, and ``SYMROT_ROUNDS`` as 1 (otherwise 0).
    """
    try:
        whole = enclosure(recurrences(program))
    except InputError:  # rates without a Taylor series, such as rates with abs
        whole = None
    rounded = None if whole is None else rounded_terms(whole)
    if rounded is None:
        return "#define SYMROT_ROUNDS 0\n"
    system, linear = rounded.system, functions_of_time(rounded)
    places = {name: f"p[{i}]" for i, name in enumerate(system.parameters)}
    lines = [f"const symrot_disc d{i} = {_rounded_disc(system, i, places, linear)};" for i in rounded.series]
    return "\n".join([
        "#define SYMROT_ROUNDS 1",
        "/* Bound the rounding errors of the rates in formulas of the time t + t_low. */",
        "static void symrot_roundings(double t, double t_low, const double *y, const double *p, double *deviation)",
        "{",
        "    const double reach = 0.0, whole = 1.0, radius[SYMROT_STATES] = {0.0};",
        *(f"    (void){name};" for name in ("t", "t_low", "reach", "whole", "y", "radius", "p")),
        *(f"    {line}" for line in [*lines, *_radii(rounded, places)]),
        "}",
        "",
    ])  # fmt: skip


def _rounded_disc(system: Recurrences, number: int, places: Mapping[str, str], linear: Mapping[int, bool]) -> str:
    """Return the C expression of a disc that contains a quantity's exact value; its centre is the computed value.

    ``number`` is the index of the quantity in ``system.series``. ``linear`` has the indices of the quantities that
    depend on t alone, each with whether it is linear in t. ``places`` maps the name of a parameter to its C text, such
    as ``p[1]``.
    """
    # the low part of the time is added to sums, and to the phases of the rule clock
    series, disc = system.series[number], _disc(system, number, places)
    if series.rule == "time":
        return "symrot_disc_of(t, fabs(t_low))"
    if number not in linear:
        return disc
    if series.rule != "sum" or linear[number]:
        centre = f"symrot_disc_of(({disc}).c, 0.0)" if linear[number] else disc
        return f"symrot_disc_rounded({centre}, 0.0)"
    *weights, constant = series.weights
    parts = [
        f"{_size(weight, places)}fabs(d{operand}.c)"
        for operand, weight in zip(series.operands, weights, strict=True)
        if weight is not None
    ]
    parts += [f"fabs({_constant(constant, places)})"] if constant is not None else []
    return f"symrot_disc_rounded({disc}, {' + '.join(parts)})"


def _radii(enclosure: Enclosure, places: Mapping[str, str]) -> list[str]:
    """Return C statements that set ``deviation[i]`` to a bound of how far rate i deviates from a constant in a step.

    The bound is the sum, over the terms of the rate in ``enclosure``, of the absolute weight times the radius of the
    disc that contains the values of the term.
    """
    return [
        f"deviation[{state}] = "
        + (" + ".join(f"{_size(weight, places)}d{operand}.r" for weight, operand in own) or "0.0")
        + ";"
        for state, own in enumerate(enclosure.terms)
    ]


def _size(weight: Node, places: Mapping[str, str]) -> str:
    return "" if weight[0] == "number" and abs(weight[1]) == 1 else f"fabs({_constant(weight, places)})*"


def _constant(node: Node, places: Mapping[str, str]) -> str:
    return c_expression(rename(node, places))


def _disc(system: Recurrences, number: int, places: Mapping[str, str]) -> str:
    """Return the C expression of a disc that contains the values of one quantity near the start of a step.

    ``number`` is the index of the quantity in ``system.series``. The values are those at complex times within ``reach``
    of t, for states within ``radius`` of y; t, reach, y and radius are variables of the C code. For the square of
    quantity 2, whose disc is d2, the expression is ``symrot_disc_square(d2)``. ``places`` maps the name of a parameter
    to its C text, such as ``p[1]``.
    """
    series = system.series[number]
    own = [f"d{operand}" for operand in value_operands(series)]
    if series.rule == "state":
        return f"symrot_disc_of(y[{series.number}], radius[{series.number}])"
    if series.rule == "time":
        return "symrot_disc_of(t, reach)"
    if series.rule == "clock":
        rate, offset = (None if weight is None else _constant(weight, places) for weight in series.weights)
        angle = f"({rate})*t" + (f" + ({offset})" if offset else "")
        further = ", whole" if series.function == "sqrt" else ""
        return f"symrot_disc_{series.function}(symrot_disc_of({angle}, fabs({rate})*reach){further})"
    if series.rule == "sum":
        *weights, constant = series.weights
        centres = [f"({_constant(w, places)})*{d}.c" for d, w in zip(own, weights, strict=True) if w is not None]
        radii = [f"{_size(w, places)}{d}.r" for d, w in zip(own, weights, strict=True) if w is not None]
        centres += [f"({_constant(constant, places)})"] if constant is not None else []
        return f"symrot_disc_of({' + '.join(centres) or '0.0'}, {' + '.join(radii) or '0.0'})"
    if series.rule == "product":
        return f"symrot_disc_square({own[0]})" if len(set(own)) == 1 else f"symrot_disc_product({', '.join(own)})"
    if series.rule == "quotient":
        inverse = f"symrot_disc_inverse({own[-1]})"
        return f"symrot_disc_product({own[0]}, {inverse})" if len(own) > 1 else inverse
    name = "ln" if series.function == "log" else series.function
    return f"symrot_disc_{name}({', '.join([*own, 'whole'] if name == 'sqrt' else own)})"
