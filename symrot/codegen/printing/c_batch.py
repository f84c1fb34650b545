"""C99 text of the function of a program for a batch of n samples.

Component i of all n samples is stored in one array, at the indices i*n to i*n + n - 1.
"""

from collections.abc import Sequence
from dataclasses import replace

from symrot.codegen.printing.c_function import (
    Real,
    c_expression,
    c_name,
    declared,
    function_body,
    function_head,
    names_used,
    silenced,
    statement,
)
from symrot.codegen.printing.kernel_functions import turning_arguments
from symrot.formula.program import Argument, Program
from symrot.formula.tree import names, rename

__all__ = ["SPAN", "batch_arguments", "c_batch", "split_by_output"]

INDEPENDENT = "SYMROT_INDEPENDENT"  # precedes a loop over independent samples: none reads a result of another
STREAMS = 16  # largest number of arrays that processors prefetch in one loop
REGISTERS = 16  # vector registers, from SSE2 to AVX2
WAYS = 12  # associativity of the first cache, 8 to 12: so many arrays fit in one set if n is a multiple of 512
SPAN = "SYMROT_SPAN"  # samples in a block of a batch: data that one loop has read are in cache for the next loop


def batch_arguments(program: Program, real: Real) -> str:
    """Return the parameter list of the batch function: ``size_t n, const double *SYMROT_RESTRICT q, ..``."""
    parts = ["size_t n"]
    for argument in program.signature.arguments:
        const = "const " if argument.role == "in" else ""
        if argument.name == "p" and argument.size:
            parts.append(declared(argument, real))
        elif argument.size:
            parts.append(f"{const}{real.type} *SYMROT_RESTRICT {argument.name}")
    return ", ".join(parts)


def _index_in_batch(index: int) -> str:
    """Return the C index of component ``index`` of sample k, such as ``2*n + k``, in the function for n samples."""
    return ("k", "n + k")[index] if index < 2 else f"{index}*n + k"


def c_batch(program: Program, real: Real, branch_free: bool) -> list[str]:
    """Return the C text of a program's batch function, which computes n samples.

    With ``branch_free``, its loops call functions without branches, such as ``symrot_sin`` of ``symrot_math.h``, which
    compilers vectorise. A block of samples with an angle out of their range is computed again with <math.h>.
    """
    head = [
        function_head(f"{c_name(program.signature.name, real)}_batch", batch_arguments(program, real)),
        "{",
        *silenced(program, "    "),
    ]
    scalars = [a for a in program.signature.arguments if a.is_scalar and a.role == "in"]
    each = {a.name: f"{a.name}_k" for a in scalars}  # a scalar of one sample is an array in a batch
    used = names_used(program)
    loaded = [f"const {real.type} {a.name}_k = {a.name}[k];" for a in scalars if a.components[0][0] in used]
    of_sample = _with_names(program, each)
    angles = turning_arguments(of_sample) if branch_free else []
    parts = split_by_output(program)
    if len(parts) > 1:
        loops = [_loop(part, real, ("start", "end"), (), "        ", INDEPENDENT, branch_free) for part in parts]
        return [*head, *_blocks(SPAN), *(line for loop in loops for line in loop), "    }", "}"]
    if not angles:
        return [*head, *_loop(of_sample, real, ("0", "n"), loaded, "    ", INDEPENDENT, branch_free), "}"]
    # a block of samples with an angle out of the range of symrot_math.h is computed again with <math.h>
    far = " + ".join(f"symrot_far{real.suffix}({c_expression(angle, real, True)})" for angle in angles)
    return [
        *head,
        *_blocks("SYMROT_BLOCK"),
        f"        {real.bits} beyond = 0;",
        *_loop(of_sample, real, ("start", "end"), loaded, "        ", INDEPENDENT, branch_free=True)[:-1],
        *statement("beyond", far, "            ", "+="),
        "        }",
        "        const size_t again = beyond == 0 ? start : end;",
        *_loop(of_sample, real, ("start", "again"), loaded, "        "),
        "    }",
        "}",
    ]


def _blocks(size: str) -> list[str]:
    """Return the first C lines of a loop over a batch in blocks of ``size`` samples, from ``start`` to ``end``."""
    return [
        f"    for (size_t start = 0; start < n; start += {size}) {{",
        f"        const size_t end = n - start < {size} ? n : start + {size};",
    ]


def split_by_output(program: Program) -> list[Program]:
    """Return the parts of a program that a batch computes in separate loops: one part for each output argument.

    The result is the whole program if separate loops are slower.
    """
    whole = _streams(program)
    scalars = any(a.is_scalar for a in program.signature.arguments if a.role == "in")
    # processors prefetch all arrays, or sines take longer than memory access
    if whole <= STREAMS or scalars or turning_arguments(program):
        return [program]
    parts = [_part(program, a) for a in program.signature.arguments if a.role == "out"]
    apart = [_streams(part) for part in parts]
    again = sum(len(part.temporaries) for part in parts) > len(program.temporaries)
    # separate loops are slower if operations are done twice, if they still access too many arrays, or over a fifth more
    # arrays than the whole program
    return [program] if again or max(apart) > STREAMS or 5 * sum(apart) > 6 * whole else parts


def _part(program: Program, output: Argument) -> Program:
    """Return the program that computes the one output argument ``output``, with only the temporaries that it needs."""
    own = {name for name, *_ in output.components}
    outputs = tuple((name, node) for name, node in program.outputs if name in own)
    needed = set().union(*(names(node) for _, node in outputs))
    temporaries = []
    for name, node in reversed(program.temporaries):
        if name in needed:
            needed |= names(node)
            temporaries.append((name, node))
    arguments = tuple(a for a in program.signature.arguments if a.role == "in" or a is output)
    return Program(replace(program.signature, arguments=arguments), tuple(reversed(temporaries)), outputs)


def _streams(program: Program) -> int:
    """Return the number of arrays, one per component, that a batch loop reads or writes; unused inputs do not count."""
    used = names_used(program)
    moved = [a for a in program.signature.arguments if a.name != "p"]
    return sum(a.role == "out" or name in used for a in moved for name, *_ in a.components)


def _stored_last(program: Program) -> list[Argument]:
    """Return the outputs in the order in which a loop computes them, if it computes all of them before it stores one.

    Empty if the loop stores each result as soon as it is computed.
    """
    # Compilers load values again after a store. If n is a multiple of 512, the arrays of all components fall into one
    # set of the first cache, which holds WAYS of them: with more, the values are no longer in it. Measured with gcc 12
    # on Zen 3 for such n, late stores multiply the time by about 0.9 (heavy_top 0.7, heavy_top_symmetric 1.1), for
    # other n by 1. For 12 arrays (quaternion_product) it would be 1.15 at n = 1000: 26 loads per iteration instead of
    # 22.
    streams = _streams(program)
    if streams <= WAYS:
        return []
    outputs = [a for a in program.signature.arguments if a.role == "out"]
    # all inputs and results fit into registers
    if streams <= REGISTERS:
        return outputs
    # Fewest inputs first. Measured with gcc 12 on Zen 3 (geometric mean over n = 512, 1000, 1024, 4096, 10^6), this
    # multiplies the time by 0.88 for inertia_tetrahedron, by 0.95 for heavy_top (1.03 at 1000, 0.97 at 10^6) and by
    # 0.98 for heavy_top_symmetric. For two kernels with fewer values, inertia_triangular_prism and inertia_frustum, the
    # factor would be 1.06.
    return sorted(outputs, key=lambda a: _streams(_part(program, a)) - a.size)


def _loop(
    program: Program, real: Real, range_: tuple[str, str], loaded: Sequence[str], indent: str, pragma: str = "",
    branch_free: bool = False,
) -> list[str]:  # fmt: skip
    start, end = range_
    inner = f"{indent}    "
    return [
        *([f"{indent}{pragma}"] if pragma else []),
        f"{indent}for (size_t k = {start}; k < {end}; ++k) {{",
        *(f"{inner}{line}" for line in loaded),
        *function_body(program, _index_in_batch, inner, real, branch_free, _stored_last(program)),
        f"{indent}}}",
    ]


def _with_names(program: Program, names: dict[str, str]) -> Program:
    """Return the program with some inputs renamed: ``{"t": "time"}`` renames t to time."""
    signature = program.signature
    arguments = tuple(
        replace(a, components=tuple((names.get(c[0], c[0]), *c[1:]) for c in a.components)) for a in signature.arguments
    )
    return Program(
        replace(signature, arguments=arguments),
        tuple((name, rename(node, names)) for name, node in program.temporaries),
        tuple((name, rename(node, names)) for name, node in program.outputs),
    )
