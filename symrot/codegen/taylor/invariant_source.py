"""C code of the conserved quantities of a motion: values in double-double arithmetic, gradients in doubles.

A double-double number is a sum of two doubles with about 32 digits, in which a drift is visible early. From the
gradients follows the smallest change of the states that restores the conserved values. The code is placed between
:file:`taylor.h` and :file:`taylor.c`; :file:`projection.c` uses it.
"""

from collections.abc import Sequence
from fractions import Fraction

from symrot.codegen.lowering.tape import Operation, Tape, tape_of
from symrot.formula.program import Program
from symrot.formula.tree import parse

__all__ = ["invariant_definitions", "projectable"]

QUATERNION = tuple(f"q{i}" for i in range(4))
NORM = "q0*q0 + q1*q1 + q2*q2 + q3*q3"
_OPERATIONS = {  # C functions of operations on pairs of doubles
    "+": "dd_add_fast", "-": "symrot_pair_subtract", "*": "symrot_pair_multiply", "/": "symrot_pair_divide",
    "neg": "dd_negative", "sqrt": "symrot_pair_root",
}  # fmt: skip
IN_PAIRS = {*_OPERATIONS, "number", "symbol"}
"""Kinds of tape entries (operations, numbers and inputs) for which double-double arithmetic is available."""


def projectable(program: Program, outputs: Sequence[str]) -> list[str]:
    """Return the names of those ``outputs`` of a program whose formulas contain only + - * / and square roots."""
    # operations of double-double arithmetic; other conserved quantities are not restored by projection
    return [name for name in outputs if {op.kind for op in tape_of(program, [name]).operations} <= IN_PAIRS]


def invariant_definitions(
    program: Program, outputs: Sequence[str], states: Sequence[str], parameters: Sequence[str]
) -> str:
    """Return the C code that evaluates the conserved quantities of a motion and their gradients.

    Parameters
    ----------
    program : Program
        Quantities that depend on t, states and parameters.
    outputs : sequence of str
        Names of the conserved quantities. Quantities that are not :func:`projectable` are left out; the squared norm of
        the quaternion is added.
    states : sequence of str
        Names of the states, in order.
    parameters : sequence of str
        Names of the parameters; the C code reads two numbers for each: its value, and the rounding error of this value.
    """
    norm = set(QUATERNION) <= set(states)
    tape = tape_of(program, projectable(program, outputs), [parse(NORM)] if norm else [])
    places = {"t": "t", **{name: f"y[{i}]" for i, name in enumerate(states)}}
    places |= {name: f"dd_pair(p[{2 * i}], p[{2 * i + 1}])" for i, name in enumerate(parameters)}
    pairs = [f"const dd v{i} = {_in_pairs(op, places)};" for i, op in enumerate(tape.operations)]
    lines = [
        f"#define SYMROT_INVARIANTS {len(tape.outputs)}",
        f"#define SYMROT_INVARIANT_PARAMETERS {2 * len(parameters)}",
        f"#define SYMROT_QUATERNION {states.index('q0') if norm else -1}",
        "",
    ]
    if tape.outputs:
        lines += [
            "static SYMROT_APART void symrot_invariants(dd t, const dd *y, const double *p,",
            "    dd *value, double (*gradient)[SYMROT_STATES])",
            "{",
            "    (void)t;",
            "    (void)p;",
            *(f"    {line}" for line in pairs),
        ]
        for number, place in enumerate(tape.outputs):
            lines.append(f"    value[{number}] = v{place};")
            lines += [f"    {line}" for line in _gradient(tape, number, states)]
        lines += ["}", ""]
    return "\n".join(lines)


def _in_pairs(op: Operation, places: dict[str, str]) -> str:
    if op.kind == "number":
        high = float(op.value)
        return f"dd_pair({high!r}, {float(op.value - Fraction(high))!r})"
    if op.kind == "symbol":
        return places[op.value]
    return f"{_OPERATIONS[op.kind]}({', '.join(f'v{i}' for i in op.operands)})"


def _gradient(tape: Tape, output: int, states: Sequence[str]) -> list[str]:
    """Return the C statements that compute the gradient of one output with respect to the states.

    The method is reverse-mode differentiation.
    """
    needed = tape.of(output)
    varying = _varying(tape, needed, set(states))
    terms: dict[int, list[str]] = {tape.outputs[output]: ["1.0"]}
    lines: list[str] = []
    for index in reversed(needed):
        op = tape.operations[index]
        if index not in varying or op.kind == "symbol":
            continue
        slope = f"g{output}_{index}"
        lines.append(f"const double {slope} = {' + '.join(terms.pop(index))};")
        for operand, share in zip(op.operands, _shares(op, index, slope), strict=True):
            if operand in varying:
                terms.setdefault(operand, []).append(share)
    derivatives = {tape.operations[index].value: " + ".join(parts) for index, parts in terms.items()}
    return lines + [f"gradient[{output}][{i}] = {derivatives.get(name, '0.0')};" for i, name in enumerate(states)]


def _varying(tape: Tape, needed: Sequence[int], states: set[str]) -> set[int]:
    varying: set[int] = set()
    for index in needed:
        op = tape.operations[index]
        if (op.kind == "symbol" and op.value in states) or varying.intersection(op.operands):
            varying.add(index)
    return varying


def _shares(op: Operation, index: int, slope: str) -> list[str]:
    """Return the C terms that an operation contributes to derivatives of a conserved quantity, one for each operand.

    The derivatives are those with respect to the operands of the operation, in reverse-mode differentiation.

    Example: ``v3 = v1*v2``, with ``index`` 3. If g (``slope``) is the derivative of the quantity with respect to v3,
    the terms ``g*v2.hi`` and ``g*v1.hi`` belong to its derivatives with respect to v1 and v2.
    """
    values = [f"v{i}.hi" for i in op.operands]
    if op.kind == "+":
        return [slope, slope]
    if op.kind == "-":
        return [slope, f"-{slope}"]
    if op.kind == "neg":
        return [f"-{slope}"]
    if op.kind == "*":
        return [f"{slope}*{values[1]}", f"{slope}*{values[0]}"]
    if op.kind == "/":
        return [f"{slope}/{values[1]}", f"-{slope}*v{index}.hi/{values[1]}"]
    return [f"0.5*{slope}/v{index}.hi"]  # sqrt
