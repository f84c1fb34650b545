"""Print a program as C99 that is also valid C++: one sample, and a batch over structure-of-arrays."""

from dataclasses import replace
from fractions import Fraction
from textwrap import wrap

from symrot.codegen.banner import WIDTH, Description, banner
from symrot.expression import Node, names, rename, text
from symrot.kernel import Argument, Program

__all__ = ["c_expression", "c_function", "c_header", "c_source"]

FUNCTIONS = {"abs": "fabs"}


def c_literal(value: Fraction) -> str:
    """Return the double nearest to an exact number, as the shortest text that reads back to it."""
    shown = repr(float(value))
    return shown if "." in shown or "e" in shown or "n" in shown else f"{shown}.0"


def c_expression(node: Node) -> str:
    """Return a formula as C, with the brackets that keep its order of evaluation."""
    return text(rename(node, functions=FUNCTIONS), 0, c_literal)


def c_arguments(program: Program) -> str:
    """Return the parameter list of the one-sample function."""
    return ", ".join(_declared(argument) for argument in program.signature.arguments if argument.size)


def _head(name: str, arguments: str, qualifier: str = "") -> str:
    """Return a function's head, its arguments on lines of their own where one line is too long."""
    head = f"{qualifier}void {name}({arguments})"
    if len(head) <= WIDTH:
        return head
    unbroken = arguments.replace(", ", ",\0").replace(" ", "\1").replace("\0", " ")  # break after commas only
    lines = wrap(unbroken, WIDTH - 4, break_long_words=False)
    return f"{qualifier}void {name}(\n    " + "\n    ".join(lines).replace("\1", " ") + ")"


def _declared(argument: Argument) -> str:
    const = "const " if argument.role == "in" else ""
    return f"double {argument.name}" if argument.is_scalar else f"{const}double {argument.name}[{argument.size}]"


def _used(program: Program) -> set[str]:
    return set().union(*(names(node) for _, node in program.temporaries + program.outputs))


def _body(program: Program, element: str, indent: str) -> list[str]:
    """Return the statements; ``element`` is the index of a component in its array, with {i} for its number."""
    used, lines = _used(program), []
    for argument in program.signature.arguments:
        if argument.role == "in" and not argument.is_scalar:
            place = "{i}" if argument.name == "p" else element
            lines += [
                f"{indent}const double {name} = {argument.name}[{place.format(i=index)}];"
                for index, (name, *_) in enumerate(argument.components)
                if name in used
            ]
    lines += [f"{indent}const double {name} = {c_expression(node)};" for name, node in program.temporaries]
    if lines:
        lines.append("")
    results = dict(program.outputs)
    for argument in program.signature.arguments:
        if argument.role == "out":
            lines += [
                f"{indent}{argument.name}[{element.format(i=index)}] = {c_expression(results[name])};"
                for index, (name, *_) in enumerate(argument.components)
            ]
    return lines


def _silenced(program: Program, indent: str) -> list[str]:
    """Return a statement for each argument that the formulas do not use, so that no compiler warns."""
    used = _used(program)
    idle = [
        argument.name
        for argument in program.signature.arguments
        if argument.role == "in" and argument.size and not any(name in used for name, *_ in argument.components)
    ]
    return [f"{indent}(void){name};" for name in idle]


def c_function(program: Program, qualifier: str = "") -> str:
    """Return the one-sample function alone.

    Parameters
    ----------
    program : Program
        What it computes. Outputs must not overlap inputs.
    qualifier : str
        In front of the definition, e.g. ``"static inline "``.
    """
    head = _head(program.signature.name, c_arguments(program), qualifier)
    lines = [head, "{", *_silenced(program, "    "), *_body(program, "{i}", "    "), "}"]
    return "\n".join(lines) + "\n"


def _batch_arguments(program: Program) -> str:
    parts = ["size_t n"]
    for argument in program.signature.arguments:
        const = "const " if argument.role == "in" else ""
        if argument.name == "p" and argument.size:
            parts.append(_declared(argument))
        elif argument.size:
            parts.append(f"{const}double *SYMROT_RESTRICT {argument.name}")
    return ", ".join(parts)


def _batch(program: Program) -> list[str]:
    scalars = [a for a in program.signature.arguments if a.is_scalar and a.role == "in"]
    used = _used(program)
    each = {a.name: f"{a.name}_k" for a in scalars}  # a scalar of one sample is an array in a batch
    return [
        _head(f"{program.signature.name}_batch", _batch_arguments(program)),
        "{",
        *_silenced(program, "    "),
        "    for (size_t k = 0; k < n; ++k) {",
        *(f"        const double {a.name}_k = {a.name}[k];" for a in scalars if a.components[0][0] in used),
        *_body(_with_names(program, each), "{i}*n + k", "        "),
        "    }",
        "}",
    ]


def _with_names(program: Program, names: dict[str, str]) -> Program:
    """Return the program with some inputs called differently."""
    signature = program.signature
    arguments = tuple(
        replace(a, components=tuple((names.get(c[0], c[0]), *c[1:]) for c in a.components)) for a in signature.arguments
    )
    return Program(
        replace(signature, arguments=arguments),
        tuple((name, rename(node, names)) for name, node in program.temporaries),
        tuple((name, rename(node, names)) for name, node in program.outputs),
    )


def _includes(program: Program) -> list[str]:
    calls = any(op not in ("add", "mul", "div", "neg") for op in program.operations())
    return ["#include <math.h>"] if calls else []


def c_header(program: Program, description: Description) -> str:
    """Return the header text: contract, include guard, both prototypes, usable from C and C++."""
    name = program.signature.name
    guard = f"SYMROT_{name.upper()}_H"
    return "\n".join([
        *banner(program, description, "/*", " *", " */"), f"#ifndef {guard}", f"#define {guard}", "",
        "#include <stddef.h>", "", "#ifndef SYMROT_RESTRICT", "#ifdef __cplusplus",
        "#define SYMROT_RESTRICT __restrict", "#else", "#define SYMROT_RESTRICT restrict", "#endif", "#endif", "",
        "#ifdef __cplusplus", 'extern "C" {', "#endif",
        "", "/* one sample */", f"{_head(name, c_arguments(program))};", "",
        "/* n samples; component i of sample k stands at [i*n + k] */",
        f"{_head(f'{name}_batch', _batch_arguments(program))};", "",
        "#ifdef __cplusplus", "}", "#endif", "", "#endif",
    ]) + "\n"  # fmt: skip


def c_source(program: Program, description: Description) -> str:
    """Return the C99 text of a kernel. Same program, same bytes: no clock, no path, no environment."""
    return "\n".join([
        *banner(program, description, "/*", " *", " */"), *_includes(program),
        f'#include "{program.signature.name}.h"', "",
        c_function(program), *_batch(program),
    ]) + "\n"  # fmt: skip
