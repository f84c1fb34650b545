"""Straight-line programs of the library's kernels, in which constants such as pi are numbers."""

from collections.abc import Iterable, Mapping
from functools import cache

from symrot.codegen.derivatives import Formulas, cheapest, ways
from symrot.codegen.printing.banner import CONTRACT, Description
from symrot.formula import exact_numbers as number
from symrot.formula.program import Program, Signature
from symrot.formula.tree import Node, children, evaluate, with_children
from symrot.kernels.definition import Box, Definition
from symrot.kernels.jacobian import BY
from symrot.kernels.library import definition

__all__ = ["kernel_description", "kernel_program"]


@cache
def kernel_program(name: str) -> Program:
    """Return the straight-line program (temporaries, then outputs) of the library kernel ``name``, for printing."""
    kernel = definition(name)
    signature = Signature(name, (*kernel.inputs, *(target for target, _ in kernel.results)))
    # there are several ways to compute a kernel with derivatives, such as quaternion_dcm_by_q
    lowered = cheapest(signature, _ways(name, kernel), "constant_")
    known = {"pi": number.PI}
    values = {name: ("number", evaluate(node, known, {"sqrt": number.sqrt})) for name, node in lowered.parameters}
    program = lowered.program
    return Program(
        signature,
        tuple((name, _with(node, values)) for name, node in program.temporaries),
        tuple((name, _with(node, values)) for name, node in program.outputs),
    )


def _ways(name: str, kernel: Definition) -> Iterable[Formulas]:
    """Return one or more sets of formulas that compute the kernel ``name``; the caller uses the cheapest."""
    formulas = Formulas(kernel.formulas, kernel.named)
    base, *variables = name.split(BY)
    # without derivatives there is one set; a kernel with derivatives has several, see ways
    if not variables:
        return (formulas,)
    plain = definition(base)
    entries = [(output, variable) for output, by, variable in (name.partition(BY) for name, _ in kernel.formulas) if by]
    groups = [[component for component, *_ in argument.components] for argument in kernel.inputs]
    return ways(Formulas(plain.formulas, plain.named), formulas, kernel_program(base), entries, groups)


def _with(node: Node, values: Mapping[str, Node]) -> Node:
    """Return a formula with symbols replaced: ``2*x`` with ``{"x": a + b}`` as ``values`` gives ``2*(a + b)``."""
    if node[0] == "symbol":
        return values.get(node[1], node)
    return with_children(node, [_with(child, values) for child in children(node)])


def kernel_description(kernel: Definition, target: str, errors: str = "") -> Description:
    """Return the texts for the head comment of a library kernel's file: title, domain, derivation, command.

    ``target`` is the language, such as ``"c"``.
    """
    # in C only: the ranges of the inputs in which rounding errors are bounded, and ``errors``, the bounds
    known = (("Box", _box(kernel.box)), *((("Errors", errors),) if errors else ()))
    return Description(
        title=kernel.title, domain=kernel.domain, derivation=kernel.derivation,
        command=f"symrot emit {kernel.name} --target {target}",
        contract=(*known, *CONTRACT) if target == "c" else (),
    )  # fmt: skip


def _box(box: Box) -> str:
    """Return the ranges of the inputs of a kernel as text, such as ``theta, phi in [-4, 4]; m in [1, 10]``."""
    names: dict[tuple[str, str], list[str]] = {}
    for name, (low, high) in box.items():
        names.setdefault((str(low), str(high)), []).append(name)
    ranges = [f"{', '.join(each)} in [{low}, {high}]" for (low, high), each in names.items()]
    return "; ".join(ranges)
