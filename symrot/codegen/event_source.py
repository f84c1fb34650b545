"""Print formulas whose zeros are sought as C: the value, and a bound of what rounding may have done to it.

The bound is carried along the tape with the value, operation by operation, to first order: it tells a curve that
touches zero from one that comes near it, and says below which size a sign means nothing.

The text stands before :file:`events.c`.
"""

from collections.abc import Sequence
from itertools import pairwise

from symrot.codegen.c_source import c_expression
from symrot.codegen.tape import Operation, tape_of
from symrot.expression import FUNCTIONS, Node
from symrot.kernel import Program

__all__ = ["event_definitions"]

SLOPES = {  # function -> a bound of its slope, from argument a and value v
    "sqrt": "0.5/{v}", "sin": "1.0", "cos": "1.0", "tan": "(1.0 + {v}*{v})", "exp": "{v}", "log": "1.0/{a}",
    "abs": "1.0", "sinh": "sqrt(1.0 + {v}*{v})", "cosh": "{v}", "tanh": "1.0", "asin": "1.0/sqrt(1.0 - {a}*{a})",
    "acos": "1.0/sqrt(1.0 - {a}*{a})", "atan": "1.0/(1.0 + {a}*{a})", "atan2": "1.0/sqrt({a}*{a} + {b}*{b})",
}  # fmt: skip
assert set(SLOPES) == set(FUNCTIONS)


def event_definitions(
    program: Program, formulas: Sequence[Node], states: Sequence[str], edges: Sequence[int], scales: Sequence[float]
) -> str:
    """Return the C function ``symrot_event`` of some formulas.

    Parameters
    ----------
    program : Program
        Quantities of t, states and parameters; the formulas may use its outputs by name.
    formulas : sequence of Node
    states : sequence of str
        Names of the states, in order.
    edges, scales
        Blocks of states, as :func:`symrot.propagation.dop853.translation_unit` takes them: a state is known to a few
        units in the last place of the largest of its block, or of the scale.
    """
    places = {"t": "t", **{name: f"y[{i}]" for i, name in enumerate(states)}}
    for argument in program.signature.arguments:
        if argument.name == "p":
            places |= {name: f"p[{i}]" for i, (name, *_) in enumerate(argument.components)}
    known = {"t": "0.0"}
    lines = [
        f"#define SYMROT_STATES {len(states)}",
        f"#define SYMROT_EVENTS {len(formulas)}",
        "",
        "static double symrot_event(int which, double t, const double *y, const double *p, double *noise)",
        "{",
        "    (void)t;",
        "    (void)y;",
        "    (void)p;",
    ]
    for b, (low, high) in enumerate(pairwise(edges)):
        size = _number(scales[b]) if scales[b] > 0.0 else _largest([f"fabs(y[{i}])" for i in range(low, high)])
        lines += [f"    const double size{b} = SYMROT_STATE_ERROR*{size};", f"    (void)size{b};"]
        known |= {states[i]: f"size{b}" for i in range(low, high)}
    lines += ["    switch (which) {"]
    for number, formula in enumerate(formulas):
        tape = tape_of(program, (), [formula])
        lines.append(f"    case {number}: {{")
        for index, op in enumerate(tape.operations):
            lines += [f"        const double {text};" for text in _statements(index, op, places, known)]
        last = tape.outputs[0]
        lines += [f"        *noise = e{last};", f"        return v{last};", "    }"]
    return "\n".join([*lines, "    }", "    *noise = 0.0;", "    return 0.0;", "}", ""])


def _number(value: float) -> str:
    return repr(float(value))


def _largest(terms: Sequence[str]) -> str:
    return terms[0] if len(terms) == 1 else f"fmax({terms[0]}, {_largest(terms[1:])})"


def _statements(index: int, op: Operation, places: dict[str, str], known: dict[str, str]) -> tuple[str, str]:
    """Return the definitions of an operation's value and of the bound of its error."""
    v, e = f"v{index}", f"e{index}"
    values, errors = [f"v{i}" for i in op.operands], [f"e{i}" for i in op.operands]
    own = f"SYMROT_ROUNDING*fabs({v})"
    if op.kind == "number":
        return f"{v} = {c_expression(('number', op.value))}", f"{e} = {'0.0' if float(op.value) == op.value else own}"
    if op.kind == "symbol":
        return f"{v} = {places[op.value]}", f"{e} = {known.get(op.value, own)}"
    if op.kind == "neg":
        return f"{v} = -{values[0]}", f"{e} = {errors[0]}"
    if op.kind in "+-":
        return f"{v} = {values[0]} {op.kind} {values[1]}", f"{e} = {errors[0]} + {errors[1]} + {own}"
    if op.kind == "*":
        shares = f"fabs({values[0]})*{errors[1]} + fabs({values[1]})*{errors[0]}"
        return f"{v} = {values[0]}*{values[1]}", f"{e} = {shares} + {own}"
    if op.kind == "/":
        shares = f"({errors[0]} + fabs({v})*{errors[1]})/fabs({values[1]})"
        return f"{v} = {values[0]}/{values[1]}", f"{e} = {shares} + {own}"
    slope = SLOPES[op.kind].format(v=v, a=values[0], b=values[-1])
    return (
        f"{v} = {c_expression(('call', op.kind, tuple(('symbol', name) for name in values)))}",
        f"{e} = fabs({slope})*({' + '.join(errors)}) + 2.0*{own}",
    )
