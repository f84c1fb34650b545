"""C99 files of programs, which are also valid C++: a source with its functions, and a header with their prototypes.

For each type of numbers there are two functions: one computes a single sample, another a batch of n samples.
"""

from collections.abc import Sequence

from symrot.codegen.printing.banner import Description, banner
from symrot.codegen.printing.c_batch import SPAN, batch_arguments, c_batch, split_by_output
from symrot.codegen.printing.c_function import (
    DOUBLE,
    Real,
    c_arguments,
    c_expression,
    c_function,
    c_name,
    function_head,
    statement,
)
from symrot.codegen.printing.kernel_functions import BRANCH_FREE, called, has_branch_free_calls, own_function
from symrot.formula.program import Program

__all__ = ["MATH_HEADER", "c_functions", "c_header", "c_source", "with_head"]

MATH_HEADER = "symrot_math.h"
RELATIONS = {"==": "eq", "<": "lt"}


def _own_function(name: str, real: Real, branch_free: bool = False) -> list[str]:
    """Return the C definition of a function, such as sinc, that kernels call and <math.h> does not contain.

    With ``branch_free``, the result is its version without branches, for the loops of batches.
    """
    parameters, temporaries, (relation, left, right, then, other) = own_function(name, real.precision)
    arguments = ", ".join(f"{real.type} {parameter}" for parameter in parameters)
    called_as = (real.branch_free_functions if branch_free else real.functions)[name]
    lines = [function_head(called_as, arguments, "static inline ", real.type), "{"]
    for temporary, node in temporaries:
        lines += statement(f"const {real.type} {temporary}", c_expression(node, real, branch_free), "    ")
    a, b, x, y = (c_expression(node, real, branch_free) for node in (left, right, then, other))
    # near x = 0 the limit or a series, elsewhere a quotient such as sin(x)/x
    choice = f"{a} {relation} {b} ? {x} : {y}"
    if branch_free:  # both are evaluated; a bit mask selects one, so that compilers can vectorise the loop
        choice = f"symrot_select_{RELATIONS[relation]}{real.suffix}({a}, {b}, {x}, {y})"
    return [*lines, f"    return {choice};", "}", ""]


def _includes(program: Program, branch_free: bool) -> list[str]:
    calls = any(op not in ("add", "mul", "div", "neg") for op in program.operations())
    return [*(["#include <math.h>"] if calls else []), *([f'#include "{MATH_HEADER}"'] if branch_free else [])]


def _prototypes(program: Program, real: Real) -> list[str]:
    name = c_name(program.signature.name, real)
    return [
        f"{function_head(name, c_arguments(program, real))};",
        f"{function_head(f'{name}_batch', batch_arguments(program, real))};",
    ]


_SPAN = (f"#ifndef {SPAN} /* samples that the loops of a batch take in turn */", f"#define {SPAN} 2048", "#endif", "")


def c_header(program: Program, description: Description, reals: Sequence[Real] = (DOUBLE,)) -> str:
    """Return the text of the header file of a kernel, for C and C++: head comment, include guard, prototypes."""
    guard = f"SYMROT_{program.signature.name.upper()}_H"
    ones, batches = zip(*(_prototypes(program, real) for real in reals), strict=True)
    shapes = ["/* one sample */", *ones, "", "/* n samples; component i of sample k is at [i*n + k] */", *batches]
    return "\n".join([
        *banner(program, description, "/*", " *", " */"), f"#ifndef {guard}", f"#define {guard}", "",
        "#include <stddef.h>", "", "#ifndef SYMROT_RESTRICT", "#ifdef __cplusplus",
        "#define SYMROT_RESTRICT __restrict", "#else", "#define SYMROT_RESTRICT restrict", "#endif", "#endif", "",
        "#ifndef SYMROT_INDEPENDENT /* in front of a loop over samples: outputs do not overlap inputs */",
        "#if defined(__clang__) && defined(__NO_MATH_ERRNO__) /* with errno, calls of <math.h> keep a loop as it is */",
        '#define SYMROT_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")',
        "#elif defined(__GNUC__) && !defined(__clang__)", '#define SYMROT_INDEPENDENT _Pragma("GCC ivdep")',
        "#else", "#define SYMROT_INDEPENDENT", "#endif", "#endif", "",
        *(_SPAN if len(split_by_output(program)) > 1 else ()),
        "#ifdef __cplusplus", 'extern "C" {', "#endif",
        "", *shapes, "",
        "#ifdef __cplusplus", "}", "#endif", "", "#endif",
    ]) + "\n"  # fmt: skip


def c_source(
    program: Program, description: Description, reals: Sequence[Real] = (DOUBLE,), branch_free: bool = False,
) -> str:  # fmt: skip
    """Return the C99 text of a kernel, which depends only on the arguments, not on time, paths or the environment.

    Parameters
    ----------
    program : Program
        The kernel.
    description : Description
        Title and other texts for the head comment.
    reals : sequence of Real
        The types of numbers; for each type a function for one sample and a batch function are printed.
    branch_free : bool
        Whether batches call functions without branches, such as those of ``symrot_math.h``, which compilers vectorise;
        see :func:`c_functions`.
    """
    return with_head(program, description, c_functions(program, reals, branch_free))


def with_head(program: Program, description: Description, functions: str) -> str:
    """Return the C file of a kernel: its head comment from ``description``, then ``functions``.

    ``functions`` is the result of :func:`c_functions`.
    """
    return "\n".join([*banner(program, description, "/*", " *", " */"), functions])


def c_functions(program: Program, reals: Sequence[Real] = (DOUBLE,), branch_free: bool = False) -> str:
    """Return the C99 text of a kernel without its head comment.

    Parameters
    ----------
    program : Program
        The kernel.
    reals : sequence of Real
        The types of numbers; for each type a function for one sample and a batch function are printed.
    branch_free : bool
        Whether batches call functions without branches, such as those of ``symrot_math.h``, which compilers vectorise.
        A block of samples with an angle out of the range of these functions is computed again with the C library.
    """
    branch_free = branch_free and has_branch_free_calls(program)
    lines = _includes(program, branch_free)
    lines += [f'#include "{program.signature.name}.h"', ""]
    for real in reals:
        for name in called(program):
            lines += _own_function(name, real)
            if branch_free and name in BRANCH_FREE:
                lines += _own_function(name, real, branch_free=True)
    parts = ["\n".join([c_function(program, real=real), *c_batch(program, real, branch_free)]) for real in reals]
    return "\n".join(lines) + "\n" + "\n\n".join(parts) + "\n"
