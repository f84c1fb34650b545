"""Kernels for comparison, generated from textbook formulas by SymPy, SymForce, CasADi and heyoka, or written by hand.

Each tool gets the formulas as textbooks print them; it shares subexpressions and differentiates by itself. C code is
compiled with the flags of symrot's kernels. A tool that is not installed is skipped.
"""

import re
from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

import sympy
from sympy import Matrix

from symrot import symbols
from symrot.certificates.readback.readback import read_kernel
from symrot.codegen.library_kernels import kernel_program
from symrot.codegen.lowering.formulas import chain, to_node
from symrot.codegen.printing.c_function import c_arguments, c_function, c_name
from symrot.conventions import INTRINSIC_SEQUENCES
from symrot.dynamics.equations import angular_acceleration, inverse
from symrot.errors import InputError
from symrot.formula.program import Program, Signature
from symrot.formula.tree import Node, children, with_children
from symrot.kernels.dynamics import TENSOR
from symrot.kernels.jacobian import BY
from symrot.kinematics.euler import rate_jacobian
from symrot.kinematics.quaternion import quaternion_rates, quaternion_to_dcm

__all__ = [
    "PEERS_IN_C",
    "TEXTBOOK",
    "by_hand",
    "casadi_counts",
    "casadi_function",
    "casadi_text",
    "counted",
    "derivatives_of",
    "input_names",
    "products",
    "textbook",
    "textbook_program",
]

BY_HAND = Path(__file__).with_name("kernels_by_hand.c")
_COUNTED = {"mul": "mul", "add": "add", "sub": "add", "div": "div", "sqrt": "sqrt"}


def _euler_rates(sequence: str) -> list[sympy.Expr]:
    return list(rate_jacobian(sequence).inverse * Matrix(symbols.omega_b))


def _quaternion_rates() -> list[sympy.Expr]:
    return list(quaternion_rates("body") * Matrix(symbols.omega_b))


def _rigid_body() -> list[sympy.Expr]:
    omega = Matrix(symbols.omega_b)
    moment = Matrix(symbols.torque_b) - omega.cross(TENSOR * omega)
    return [*(inverse(TENSOR) * moment), *_quaternion_rates()]


def _heavy_top() -> list[sympy.Expr]:
    weight = symbols.W * Matrix(symbols.center_of_mass).cross(-quaternion_to_dcm().T.col(2))
    alpha = angular_acceleration(sympy.diag(*symbols.principal), Matrix(symbols.omega_b), weight)
    return [*alpha, *_quaternion_rates()]


TEXTBOOK: dict[str, Callable[[], list[sympy.Expr]]] = {
    "quaternion_dcm": lambda: list(quaternion_to_dcm()),
    **{f"euler_{sequence.lower()}_body_rates": partial(_euler_rates, sequence) for sequence in INTRINSIC_SEQUENCES},
    "rigid_body_tensor": _rigid_body,
    "heavy_top": _heavy_top,
}
"""The kernels that other tools can produce too: name -> function that returns the formulas of textbooks."""


def derivatives_of(name: str) -> tuple[str, list[tuple[str, str]]]:
    """Return the name of the kernel that ``name`` extends by derivatives, and the derivatives as pairs (output, input).

    For ``euler_zxz_body_rates_by_angles`` these are ``euler_zxz_body_rates`` and nine pairs such as ("dphi", "theta").
    A kernel without derivatives gives its own name and an empty list.
    """
    entries = [output.split(BY) for output in _outputs(kernel_program(name).signature) if BY in output]
    return name.split(BY)[0], [(output, variable) for output, variable in entries]


def textbook(name: str) -> list[sympy.Expr]:
    """Return the formulas of a kernel as textbooks print them, in the order of its outputs, derivatives last.

    Raises
    ------
    InputError
        If the kernel is not in :data:`TEXTBOOK`.
    """
    base, *variables = name.split(BY)
    if base not in TEXTBOOK:
        raise InputError(f"expected a kernel with a textbook formula ({', '.join(TEXTBOOK)}), got {name!r}")
    values = TEXTBOOK[base]()
    if not variables:
        return values
    formulas = dict(zip(_outputs(kernel_program(base).signature), values, strict=True))
    symbol = {str(each): each for value in values for each in value.free_symbols}
    _, entries = derivatives_of(name)
    return values + [
        formulas[output].diff(symbol.get(variable, sympy.Symbol(variable))) for output, variable in entries
    ]


def input_names(name: str) -> list[str]:
    """Return the names of the numbers that the kernel ``name`` takes, in order: ``q0`` to ``q3`` for a quaternion."""
    return [name for a in kernel_program(name).signature.arguments if a.role == "in" for name, *_ in a.components]


def textbook_program(name: str) -> Program:
    """Return the textbook formulas of the kernel ``name`` as a program, without shared subexpressions."""
    signature = kernel_program(name).signature
    # Each tool shares common subexpressions in its own way.
    return Program(signature, (), tuple(zip(_outputs(signature), map(to_node, textbook(name)), strict=True)))


def _outputs(signature: Signature) -> list[str]:
    return [name for a in signature.arguments if a.role == "out" for name, *_ in a.components]


def _program(name: str, common: Sequence[tuple[Any, Any]], results: Sequence[Any]) -> str:
    """Return C text of the kernel ``name`` that computes common terms (pairs of symbol and value) first and then the
    results.
    """
    signature = kernel_program(name).signature
    # Nothing is simplified further, so that the operations are those of the tool (such as SymPy's ``cse``).
    temporaries = tuple((str(symbol), products(to_node(value))) for symbol, value in common)
    outputs = tuple(zip(_outputs(signature), (products(to_node(value)) for value in results), strict=True))
    return c_function(Program(signature, temporaries, outputs), "static inline ")


def products(node: Node) -> Node:
    """Return the formula ``node`` with integer powers written as products (x*x), since C has no power operator."""
    if node[0] == "**":
        return chain("*", [products(node[1])] * node[2])
    return with_children(node, list(map(products, children(node))))


def _sympy(name: str) -> str:
    return _program(name, *sympy.cse(textbook(name), symbols=sympy.numbered_symbols("common"), optimizations="basic"))


def _symforce(name: str) -> str:
    sf: Any = import_module("symforce.symbolic")
    base, entries = derivatives_of(name)
    values = [sf.S(str(entry)) for entry in textbook(base)]
    formulas = dict(zip(_outputs(kernel_program(base).signature), values, strict=True))
    values += [formulas[output].diff(sf.Symbol(variable)) for output, variable in entries]
    common, results = sf.cse(values, symbols=(sf.Symbol(f"common{i}") for i in range(1000)))

    def plain(value: object) -> sympy.Expr:
        return sympy.sympify(str(value), locals=_REAL)

    return _program(name, [(symbol, plain(value)) for symbol, value in common], [plain(value) for value in results])


_REAL = {name: sympy.Symbol(name, real=True) for name in ("W", "S", "C", "I", "E", "N", "O", "Q")}


def by_hand(name: str) -> str | None:
    """Return the C text of the kernel ``name`` that was written by hand, or None if nobody has written one."""
    text = BY_HAND.read_text(encoding="utf-8")
    return text if f" {c_name(name)}(" in text else None


PEERS_IN_C: dict[str, Callable[[str], str | None]] = {"by hand": by_hand, "SymPy cse": _sympy, "SymForce": _symforce}


def counted(text: str, name: str) -> Counter[str]:
    """Return the number of operations of each kind in the C function of the kernel ``name`` in ``text``."""
    text = re.sub(r"^#include.*\n", "", text, flags=re.MULTILINE)
    counts: Counter[str] = Counter()
    # Equal operations are one node, so they count once.
    for node in read_kernel(text, c_name(name)).nodes:
        if node[0] in _COUNTED:
            counts[_COUNTED[node[0]]] += 1
        elif node[0] == "call":
            counts[node[1]] += 1
    return counts


def casadi_function(name: str, program: Callable[[str], Program] = textbook_program) -> tuple[Any, Counter[str]]:
    """Return CasADi's function from a kernel's inputs (one vector) to its values and derivatives.

    The second result says how many operations of each kind the function needs.

    Parameters
    ----------
    name : str
        The kernel.
    program : callable
        Returns the formulas of the kernel without derivatives: those of textbooks, or symrot's own program.
    """
    import casadi

    x = casadi.SX.sym("x", len(input_names(name)))
    values = {each: x[i] for i, each in enumerate(input_names(name))}
    functions = {each: getattr(casadi, each) for each in ("sin", "cos", "tan", "sqrt")}
    base, entries = derivatives_of(name)
    formulas = program(base).evaluate(values, functions, float)
    outputs, rows, variables = casadi.vertcat(*formulas.values()), list(formulas), input_names(name)
    # CasADi differentiates in the mode it chooses, forward and in reverse; the one with the fewest operations counts.
    ways = [casadi.jacobian(outputs, x)]
    if entries:
        ways += [
            casadi.horzcat(*(casadi.jtimes(outputs, x, one)
                             for one in casadi.horzsplit(casadi.DM.eye(len(variables))))),
            casadi.vertcat(*(casadi.jtimes(outputs, x, one, True).T
                             for one in casadi.horzsplit(casadi.DM.eye(len(rows))))),
        ]  # fmt: skip
    made = [
        casadi_counts(x, casadi.vertcat(outputs, *(slopes[rows.index(o), variables.index(v)] for o, v in entries)))
        for slopes in ways
    ]
    return min(made, key=lambda each: each[1].total())


def casadi_counts(x: Any, outputs: Any) -> tuple[Any, Counter[str]]:
    """Return a function of CasADi from ``x`` to ``outputs``, and how many operations of each kind it needs.

    Common subexpressions are computed once.
    """
    import casadi

    function = casadi.Function("peer", [x], [casadi.densify(casadi.cse(outputs))])
    kinds = {"OP_ADD": "add", "OP_SUB": "add", "OP_MUL": "mul", "OP_SQ": "mul", "OP_TWICE": "add", "OP_DIV": "div",
             "OP_INV": "div", "OP_SIN": "sin", "OP_COS": "cos", "OP_SQRT": "sqrt"}  # fmt: skip
    by_number = {getattr(casadi, kind): operation for kind, operation in kinds.items()}
    counts = Counter(
        by_number[number]
        for number in (function.instruction_id(k) for k in range(function.n_instructions()))
        if number in by_number
    )
    return function, counts


def casadi_text(function: Any, signature: Signature) -> str:
    """Return the C code that CasADi generates for ``function``, and a kernel with ``signature`` that calls it."""
    import casadi

    generator = casadi.CodeGenerator("peer", {"with_header": False})
    generator.add(function)
    inputs, outputs = ([a for a in signature.arguments if a.role == role] for role in ("in", "out"))
    values = ", ".join(a.name if a.is_scalar else f"{a.name}[{i}]" for a in inputs for i in range(a.size))
    results = [f"{a.name}[{i}]" for a in outputs for i in range(a.size)]
    # CasADi writes all results into one array: that of the only output, or another one, which is then copied.
    alone = len(outputs) == 1
    body = [
        f"const double peer_in[] = {{{values}}};", "const double *arg[1] = {peer_in};",
        *([] if alone else [f"double peer_out[{len(results)}];"]),
        f"double *res[1] = {{{outputs[0].name if alone else 'peer_out'}}};", "peer(arg, res, 0, 0, 0);",
        *([] if alone else [f"{result} = peer_out[{i}];" for i, result in enumerate(results)]),
    ]  # fmt: skip
    head = f"static inline void {c_name(signature.name)}({c_arguments(Program(signature, (), ()))})"
    return str(generator.dump()) + "\n".join([head, "{", *(f"    {line}" for line in body), "}"]) + "\n"
