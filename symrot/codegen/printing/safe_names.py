"""Programs whose variables have names that a language allows; the constants of a scene may have any name."""

from collections.abc import Collection
from dataclasses import replace

from symrot.formula.program import Program
from symrot.formula.tree import rename

__all__ = ["with_safe_names"]


def with_safe_names(program: Program, reserved: Collection[str]) -> Program:
    """Return the program in which variables with ``reserved`` names, such as ``in`` in Python, have other names."""
    inputs = [name for a in program.signature.arguments if a.role == "in" for name, *_ in a.components]
    variables = [*inputs, *(name for name, _ in program.temporaries)]
    safe: dict[str, str] = {}
    for name in variables:
        if name in reserved:
            safe[name] = next(each for each in (name + "_" * k for k in range(1, 99)) if each not in variables)
    if not safe:
        return program
    arguments = tuple(
        replace(a, components=tuple((safe.get(c[0], c[0]) if a.role == "in" else c[0], *c[1:]) for c in a.components))
        for a in program.signature.arguments
    )
    return Program(
        replace(program.signature, arguments=arguments),
        tuple((safe.get(name, name), rename(node, safe)) for name, node in program.temporaries),
        tuple((name, rename(node, safe)) for name, node in program.outputs),
    )
