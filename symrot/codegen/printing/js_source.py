"""JavaScript text of programs: a module that exports a function for one sample.

The statements are those of the C text, in the same order, so that both compute the same operations.
"""

from fractions import Fraction

from symrot.codegen.printing.banner import Description, banner
from symrot.codegen.printing.kernel_functions import called, own_function
from symrot.codegen.printing.safe_names import with_safe_names
from symrot.formula.program import Argument, Program
from symrot.formula.tree import FUNCTIONS, Node, names, rename, text
from symrot.kernels.removable import FUNCTIONS as OWN_FUNCTIONS

__all__ = ["js_expression", "js_function", "js_functions", "js_source"]

NAMES = {name: f"Math.{name}" for name in FUNCTIONS} | {name: name for name in OWN_FUNCTIONS}
"""A function of programs -> its name in JavaScript, where all angles are in rad too."""

_WORDS = """
arguments await break case catch class const continue debugger default delete do else enum eval export extends false
finally for function if implements import in instanceof interface let new null package private protected public return
static super switch this throw true try typeof var void while with yield undefined NaN Infinity Math Object
"""
RESERVED = {*_WORDS.split(), "copysign", *OWN_FUNCTIONS}
"""Names that no variable of a program may have in its JavaScript text: words of JavaScript, and called functions."""

COPYSIGN = [
    "function copysign(x, y) {",
    "    return (y < 0 || Object.is(y, -0) ? -1 : 1)*Math.abs(x);",
    "}",
]
"""The lines of the function copysign, which C has and JavaScript lacks."""


def _literal(value: Fraction) -> str:
    return repr(float(value))


def js_expression(node: Node) -> str:
    """Return a formula as a JavaScript expression, with the brackets that its order of evaluation needs."""
    return text(rename(node, functions=NAMES), 0, _literal)


def _own_function(name: str) -> list[str]:
    """Return the definition of a function, such as sinc, that kernels call and JavaScript does not have."""
    if name == "copysign":
        return COPYSIGN
    parameters, temporaries, (relation, left, right, then, other) = own_function(name, "binary64")
    condition = f"{js_expression(left)} {relation.replace('==', '===')} {js_expression(right)}"
    return [
        f"function {name}({', '.join(parameters)}) {{",
        *(f"    const {temporary} = {js_expression(node)};" for temporary, node in temporaries),
        f"    return {condition} ? {js_expression(then)} : {js_expression(other)};",
        "}",
    ]


def _unpacked(argument: Argument, used: set[str]) -> list[str]:
    """Return JavaScript statements such as ``const q0 = q[0];`` for the components of an argument that are ``used``."""
    # a scalar argument needs no statement
    if argument.is_scalar:
        return []
    return [
        f"    const {name} = {argument.name}[{i}];" for i, (name, *_) in enumerate(argument.components) if name in used
    ]


def _length_check(argument: Argument) -> str:
    # by index, JavaScript would ignore the last number of a quaternion that is passed for an angular velocity
    name, expected = argument.name, f"{argument.size} number{'s' * (argument.size > 1)}"
    refusal = f"throw new RangeError(`{name}: expected {expected}, got ${{{name}.length}}`);"
    return f"    if ({name}.length !== {argument.size}) {refusal}"


def js_function(program: Program, qualifier: str = "", checked: bool = False) -> list[str]:
    """Return the lines of a JavaScript function that writes the outputs into arrays, as the C function does.

    Parameters
    ----------
    program : Program
        The program to print. Its outputs must not overlap its inputs.
    qualifier : str
        Text in front of the definition, such as ``"export "``.
    checked : bool
        Whether the function throws a RangeError if an input array has another length than the kernel's argument.
    """
    program = with_safe_names(program, RESERVED)
    arguments = [a for a in program.signature.arguments if a.size]
    used = set().union(*(names(node) for _, node in program.temporaries + program.outputs))
    results = dict(program.outputs)
    lines = [f"{qualifier}function {program.signature.name}({', '.join(a.name for a in arguments)}) {{"]
    inputs = [a for a in arguments if a.role == "in"]
    if checked:
        lines += [_length_check(a) for a in inputs if not a.is_scalar]
    lines += [line for a in inputs for line in _unpacked(a, used)]
    lines += [f"    const {name} = {js_expression(node)};" for name, node in program.temporaries]
    lines += [
        f"    {a.name}[{i}] = {js_expression(results[name])};"
        for a in arguments
        if a.role == "out"
        for i, (name, *_) in enumerate(a.components)
    ]
    return [*lines, "}"]


def js_functions(*programs: Program) -> list[str]:
    """Return the definitions, each once, of the functions that ``programs`` call and JavaScript lacks, such as sinc."""
    needed = dict.fromkeys(name for program in programs for name in _called(program))
    return [line for name in needed for line in (*_own_function(name), "")]


def _called(program: Program) -> list[str]:
    calls_copysign = "copysign" in program.operations()
    return [*(["copysign"] if calls_copysign else []), *called(program)]


def js_source(program: Program, description: Description) -> str:
    """Return the text of a JavaScript module that exports one function, which writes the outputs into arrays."""
    # the same program gives the same bytes
    head = banner(program, description, "/*", " *", " */")
    return "\n".join([*head, "", *js_functions(program), *js_function(program, "export ", checked=True)]) + "\n"
