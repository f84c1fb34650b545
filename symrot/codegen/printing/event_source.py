"""C code of event functions (functions whose zeros are sought): values, bounds of their errors, and enclosures.

If the absolute value of a function is smaller than the error bound, its sign is unknown. Enclosures (real intervals and
complex discs) contain all values of the formula over an interval of time, and so prove where there is no zero.

The code is placed between :file:`event_enclosures.h` and :file:`events.c`.
"""

from collections.abc import Sequence
from itertools import pairwise

from symrot.codegen.lowering.tape import Operation, Tape, tape_of
from symrot.codegen.printing.c_function import c_expression
from symrot.formula.program import Program
from symrot.formula.tree import FUNCTIONS, Node

__all__ = ["event_definitions"]

SLOPES = {  # function -> a bound of its slope, given its argument a and its value v
    "sqrt": "0.5/{v}", "sin": "1.0", "cos": "1.0", "tan": "(1.0 + {v}*{v})", "exp": "{v}", "log": "1.0/{a}",
    "abs": "1.0", "sinh": "sqrt(1.0 + {v}*{v})", "cosh": "{v}", "tanh": "1.0", "asin": "1.0/sqrt(1.0 - {a}*{a})",
    "acos": "1.0/sqrt(1.0 - {a}*{a})", "atan": "1.0/(1.0 + {a}*{a})", "atan2": "1.0/sqrt({a}*{a} + {b}*{b})",
}  # fmt: skip
assert set(SLOPES) == set(FUNCTIONS)
ENCLOSURES = {  # kind -> the C call that encloses a number with an error, and the enclosure of all numbers
    "range": ("symrot_range_around", "symrot_nowhere()"), "disc": ("symrot_disc_of", "symrot_disc_unknown()"),
}  # fmt: skip
JUMPS = ("/", "tan", "atan2")  # kinds of operations whose result may jump
OPERATIONS = {"+": "add", "-": "sub", "*": "mul", "/": "div", "neg": "neg"}


def event_definitions(
    program: Program, formulas: Sequence[Node], states: Sequence[str], edges: Sequence[int], scales: Sequence[float]
) -> str:
    """Return the C functions that evaluate event functions along a motion: values, error bounds and enclosures.

    Parameters
    ----------
    program : Program
        Quantities that depend on t, states and parameters; the formulas may contain the names of these quantities.
    formulas : sequence of Node
        The event functions.
    states : sequence of str
        Names of the states, in order.
    edges : sequence of int
        State i is in block j if ``edges[j] <= i < edges[j + 1]``.
    scales : sequence of float
        One number per block. The error of a state is assumed to be a few units in the last place of this number or,
        if it is 0, of the largest state in the block.
    """
    places = {"t": "t", **{name: f"y[{i}]" for i, name in enumerate(states)}}
    for argument in program.signature.arguments:
        if argument.name == "p":
            places |= {name: f"p[{i}]" for i, (name, *_) in enumerate(argument.components)}
    known, sizes = {"t": "0.0"}, []
    for b, (low, high) in enumerate(pairwise(edges)):
        size = _number(scales[b]) if scales[b] > 0.0 else _largest([f"fabs(y[{i}])" for i in range(low, high)])
        sizes += [f"    const double size{b} = SYMROT_STATE_ERROR*{size};", f"    (void)size{b};"]
        known |= {states[i]: f"size{b}" for i in range(low, high)}
    tapes = [tape_of(program, (), [formula]) for formula in formulas]
    spans = [_span(tape, states, edges) for tape in tapes]
    cost = max((len(tape.operations) for tape in tapes), default=1)
    values = [
        [text for i, op in enumerate(tape.operations) for text in _statements(i, op, places, known)] for tape in tapes
    ]
    lines = [
        f"#define SYMROT_STATES {len(states)}",
        f"#define SYMROT_EVENTS {len(formulas)}",
        f"#define SYMROT_COST {cost}  /* operations in the longest formula */",
        "",
        "/* The states that each event depends on: the first, and the one behind the last. */",
        f"static const int symrot_spans[][2] = {{{', '.join(f'{{{a}, {b}}}' for a, b in [*spans, (0, 0)])}}};",
        "",
        "static double symrot_event(int which, double t, const double *y, const double *p, double *noise)",
        *_switch(sizes, tapes, values, ["*noise = e{last};", "return v{last};"]),
        "    *noise = 0.0;",
        "    return 0.0;",
        "}",
    ]
    for kind, (around, ending) in ENCLOSURES.items():
        texts = [
            [f"x{i} = {_enclosed(kind, around, op, places, known)}" for i, op in enumerate(tape.operations)]
            for tape in tapes
        ]
        lines += [
            "",
            f"static symrot_{kind} symrot_event_{kind}(",
            "    int which, double t, double h, const double *y, const double *r, const double *p)",
            *_switch(["    (void)h;", "    (void)r;", *sizes], tapes, texts, ["return x{last};"], f"symrot_{kind}"),
            f"    return {ending};",
            "}",
        ]
    # symrot_event_jumps: whether the function may jump between t - h and t + h
    around, _ = ENCLOSURES["range"]
    texts = [
        [f"x{i} = {_enclosed('range', around, op, places, known)}" for i, op in enumerate(tape.operations)]
        if any(op.kind in JUMPS for op in tape.operations) else []
        for tape in tapes
    ]  # fmt: skip
    lines += [
        "",
        "static int symrot_event_jumps(",
        "    int which, double t, double h, const double *y, const double *r, const double *p)",
        *_switch(["    (void)h;", "    (void)r;", *sizes], tapes, texts, [], "symrot_range", list(map(_jumps, tapes))),
        "    return 0;",
        "}",
    ]
    return "\n".join([*lines, ""])


def _jumps(tape: Tape) -> list[str]:
    """Return C statements that return whether the value of a formula may jump.

    ``tape`` lists the operations of the formula, in the order of computation. The C variables x0, x1, ... hold the
    ranges of the results of these operations.
    """
    jumps = []
    for op in tape.operations:
        if op.kind in JUMPS:
            operands = op.operands[1:] if op.kind == "/" else op.operands
            jumps.append(f"symrot_jumps_{OPERATIONS.get(op.kind, op.kind)}({', '.join(f'x{i}' for i in operands)})")
    return ["(void)x{last};", f"return {' || '.join(jumps)};"] if jumps else ["return 0;"]


def _switch(
    head: Sequence[str],
    tapes: Sequence[Tape],
    texts: Sequence[Sequence[str]],
    ends: Sequence[str],
    kind: str = "double",
    own_ends: Sequence[Sequence[str]] = (),
) -> list[str]:
    """Return the first lines of a C function body: ``head``, then ``switch (which)`` with a case per event function.

    Case k defines the values ``texts[k]``, such as ``v3 = v1*v2``, as constants of the C type ``kind``. The case ends
    with the statements ``own_ends[k]``; if ``own_ends`` is empty, all cases end with ``ends``. ``tapes[k]`` lists the
    operations of event function k; in the final statements ``{last}`` becomes the index of the operation that gives its
    value. The caller adds the C lines after the switch.
    """
    lines = ["{", "    (void)t;", "    (void)y;", "    (void)p;", *head, "    switch (which) {"]
    for number, (tape, statements) in enumerate(zip(tapes, texts, strict=True)):
        lines += [f"    case {number}: {{", *(f"        const {kind} {text};" for text in statements)]
        last = own_ends[number] if own_ends else ends
        lines += [*(f"        {end.format(last=tape.outputs[0])}" for end in last), "    }"]
    return [*lines, "    }"]


def _span(tape: Tape, states: Sequence[str], edges: Sequence[int]) -> tuple[int, int]:
    """Return (first, stop): the states on which an event function depends have indices from first to stop - 1.

    ``tape`` lists the operations of the function. The range is extended to whole blocks of states, such as the
    components of omega, which share one bound of their errors. Block j has the states ``edges[j]`` to
    ``edges[j + 1] - 1``. Without any state, the result is (0, 0).
    """
    used = {op.value for op in tape.operations if op.kind == "symbol"}
    places = [i for i, name in enumerate(states) if name in used]
    if not places:
        return 0, 0
    return max(edge for edge in edges if edge <= places[0]), min(edge for edge in edges if edge > places[-1])


def _number(value: float) -> str:
    return repr(float(value))


def _largest(terms: Sequence[str]) -> str:
    return terms[0] if len(terms) == 1 else f"fmax({terms[0]}, {_largest(terms[1:])})"


def _statements(index: int, op: Operation, places: dict[str, str], known: dict[str, str]) -> tuple[str, str]:
    """Return two C definitions for operation ``op``, which has the number ``index`` in its formula.

    For number 3, they define its value v3 and the bound e3 of the error of v3. ``places`` maps each input to its C
    text, such as ``y[2]``. ``known`` maps each state to the C text of a bound of its error.
    """
    v, e = f"v{index}", f"e{index}"  # errors to first order
    values, errors = [f"v{i}" for i in op.operands], [f"e{i}" for i in op.operands]
    own = f"SYMROT_ROUNDING*fabs({v})"
    if op.kind == "number":
        return f"{v} = {c_expression(('number', op.value))}", f"{e} = {'0.0' if float(op.value) == op.value else own}"
    if op.kind == "symbol":
        # inputs that are not in known have the error of one rounding
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
    if op.kind == "exp":
        return f"{v} = symrot_exp({values[0]})", f"{e} = {v}*{errors[0]} + 2.0*{own}"
    slope = SLOPES[op.kind].format(v=v, a=values[0], b=values[-1])
    return (
        f"{v} = {c_expression(('call', op.kind, tuple(('symbol', name) for name in values)))}",
        f"{e} = fabs({slope})*({' + '.join(errors)}) + 2.0*{own}",
    )


def _enclosed(kind: str, around: str, op: Operation, places: dict[str, str], known: dict[str, str]) -> str:
    """Return the C expression that encloses the result of an operation: a call of a function in event_enclosures.h.

    ``kind`` is the kind of enclosure, a key of ``ENCLOSURES``, and ``around`` the C function that makes an enclosure
    from a centre and a radius. ``places`` maps each input to its C text, such as ``y[2]``. ``known`` maps each state to
    the C text of a bound of its error.
    """
    if op.kind == "number":
        return f"symrot_{kind}_point({c_expression(('number', op.value))})"
    if op.kind == "symbol":
        place = places[op.value]
        if place == "t":
            return f"{around}(t, h)"
        if op.value in known:
            return f"{around}({place}, {place.replace('y', 'r')} + {known[op.value]})"
        return f"symrot_{kind}_point({place})"
    if op.kind == "*" and op.operands[0] == op.operands[1]:
        return f"symrot_{kind}_square(x{op.operands[0]})"
    name = OPERATIONS.get(op.kind, op.kind)
    return f"symrot_{kind}_{name}({', '.join(f'x{i}' for i in op.operands)})"
