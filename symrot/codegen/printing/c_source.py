"""C99 code of programs, which is also valid C++: one function computes a single sample, another a batch of n samples.

In a batch, component i of all n samples is stored in one array, at the indices i*n to i*n + n - 1.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from struct import pack, unpack
from textwrap import wrap

from symrot.codegen.printing.banner import WIDTH, Description, banner
from symrot.codegen.printing.kernel_functions import (
    NEAR,
    called,
    has_branch_free_calls,
    own_function,
    turning_arguments,
)
from symrot.formula.program import Argument, Program
from symrot.formula.tree import FUNCTIONS, Node, names, rename, text
from symrot.kernels.removable import FUNCTIONS as OWN_FUNCTIONS

__all__ = [
    "DOUBLE",
    "FLOAT",
    "MATH_HEADER",
    "Real",
    "c_expression",
    "c_function",
    "c_functions",
    "c_header",
    "c_name",
    "c_source",
    "with_head",
]

MATH_HEADER = "symrot_math.h"
INDEPENDENT = "SYMROT_INDEPENDENT"  # precedes a loop over independent samples: none reads a result of another
RELATIONS = {"==": "eq", "<": "lt"}
STREAMS = 16  # largest number of arrays that processors prefetch in one loop
REGISTERS = 16  # vector registers, from SSE2 to AVX2
WAYS = 12  # associativity of the first cache, 8 to 12: so many arrays fit in one set if n is a multiple of 512
SPAN = "SYMROT_SPAN"  # samples in a block of a batch: data that one loop has read are in cache for the next loop


@dataclass(frozen=True)
class Real:
    """A floating-point type of C, with the names and literals that C code for it contains."""

    type: str  # its name
    suffix: str  # of its functions and literals, as in sinf
    precision: str  # its format, such as binary64

    def literal(self, value: Fraction) -> str:
        """Return the shortest C literal, such as ``0.1`` or ``0.1f``, of this type's number nearest to ``value``."""
        digits = _shortest_float(value) if self.suffix else repr(float(value))
        return (digits if "." in digits or "e" in digits or "n" in digits else f"{digits}.0") + self.suffix

    @cached_property
    def functions(self) -> dict[str, str]:
        """The C names, for this type, of all functions that kernels call: ``sin`` is ``sinf`` for float."""
        own = {name: f"symrot_{name}" for name in OWN_FUNCTIONS}
        in_c = {name: name for name in FUNCTIONS} | own | {"abs": "fabs", "copysign": "copysign"}
        return {name: f"{called}{self.suffix}" for name, called in in_c.items()}

    @cached_property
    def near_functions(self) -> dict[str, str]:
        """The C names of all functions that batches call: ``sin`` is ``symrot_sin`` of ``symrot_math.h``."""
        # valid for moderate angles only
        own = {name: f"symrot_near_{name}{self.suffix}" for name in NEAR}
        shared = {"sin": "sin", "cos": "cos", "atan2": "atan2", "select_ge": "choose_ge"}
        return self.functions | own | {name: f"symrot_{other}{self.suffix}" for name, other in shared.items()}

    @property
    def bits(self) -> str:
        """The unsigned integer type of C with as many bits as this type, such as ``uint64_t`` for double."""
        return "uint32_t" if self.suffix else "uint64_t"


DOUBLE = Real("double", "", "binary64")
FLOAT = Real("float", "f", "binary32")


def _shortest_float(value: Fraction) -> str:
    for digits in range(1, 10):
        literal = f"{float(value):.{digits}g}"
        if _as_float(float(literal)) == _as_float(float(value)):
            break
    return literal


def _as_float(value: float) -> float:
    return float(unpack("f", pack("f", value))[0])


def c_expression(node: Node, real: Real = DOUBLE, near: bool = False) -> str:
    """Return a formula as a C expression of type ``real``, with brackets that preserve the order of evaluation.

    With ``near``, functions of ``symrot_math.h``, such as ``symrot_sin``, are called.
    """
    # compilers vectorise the near functions, which are valid for moderate angles only
    return text(rename(node, functions=real.near_functions if near else real.functions), 0, real.literal)


def c_arguments(program: Program, real: Real = DOUBLE) -> str:
    """Return the parameter list of the C function for one sample: ``double t, const double q[4], double dcm[9]``."""
    return ", ".join(_declared(argument, real) for argument in program.signature.arguments if argument.size)


def _head(name: str, arguments: str, qualifier: str = "", returns: str = "void") -> str:
    """Return the head of a C function, such as ``void f(double x)``, with line breaks if it is long."""
    head = f"{qualifier}{returns} {name}({arguments})"
    if len(head) <= WIDTH:
        return head
    unbroken = arguments.replace(", ", ",\0").replace(" ", "\1").replace("\0", " ")  # break after commas only
    lines = wrap(unbroken, WIDTH - 4, break_long_words=False)
    return f"{qualifier}{returns} {name}(\n    " + "\n    ".join(lines).replace("\1", " ") + ")"


def _declared(argument: Argument, real: Real) -> str:
    const = "const " if argument.role == "in" else ""
    size = "" if argument.is_scalar else f"[{argument.size}]"
    return f"{'' if argument.is_scalar else const}{real.type} {argument.name}{size}"


def _used(program: Program) -> set[str]:
    return set().union(*(names(node) for _, node in program.temporaries + program.outputs))


def _statement(head: str, formula: str, indent: str, mark: str = "=") -> list[str]:
    """Return the lines of the C statement ``head = formula;``, broken after operators if one line is too long.

    ``mark`` is written in place of ``=``, such as ``+=``.
    """
    line = f"{indent}{head} {mark} {formula};"
    if len(line) <= WIDTH + 10:
        return [line]
    return wrap(line, WIDTH + 10, subsequent_indent=f"{indent}    ", break_long_words=False, break_on_hyphens=False)


def _index_of_one(index: int) -> str:
    """Return the C index of component ``index`` of an argument in the function for one sample: the number itself."""
    return str(index)


def _index_in_batch(index: int) -> str:
    """Return the C index of component ``index`` of sample k, such as ``2*n + k``, in the function for n samples."""
    return ("k", "n + k")[index] if index < 2 else f"{index}*n + k"


def _body(
    program: Program, index_of: Callable[[int], str], indent: str, real: Real, near: bool = False, late: bool = False
) -> list[str]:  # fmt: skip
    """Return the C statements of a program; a value is computed just before the first output that needs it."""
    # this order keeps few values in use at a time, so that they fit into registers
    results = dict(program.outputs)
    lines: list[str] = []
    stores: dict[str, list[str]] = {a.name: [] for a in program.signature.arguments}
    reserved = _reserved(program, real)
    waiting: dict[str, tuple[set[str], list[str]]] = {}  # name -> names that its statement needs, the statement
    for argument in program.signature.arguments:
        if argument.role == "in" and not argument.is_scalar:
            own_index = _index_of_one if argument.name == "p" else index_of
            for index, (name, *_) in enumerate(argument.components):
                statement = f"{indent}const {real.type} {name} = {argument.name}[{own_index(index)}];"
                waiting[name] = (set(), [statement])
    angles = [node[1] for node in turning_arguments(program) if node[1] in waiting]
    waiting = {name: waiting[name] for name in (*angles, *waiting)}  # gcc calls sincos at the place of the angle
    for name, node in program.temporaries:
        statements = _statement(f"const {real.type} {name}", c_expression(node, real, near), indent)
        waiting[name] = (names(node), statements)
    outputs = [a for a in program.signature.arguments if a.role == "out"]
    # late: results are held in variables and assigned at the end, see _stores_last
    for argument in _computed_in_turn(program) if late else outputs:
        due = _due(set().union(*(names(results[name]) for name, *_ in argument.components)), waiting)
        lines += [*([""] if due and lines else []), *due, *([""] if due else [])]
        for index, (name, *_) in enumerate(argument.components):
            target, value = f"{argument.name}[{index_of(index)}]", c_expression(results[name], real, near)
            if late and results[name][0] not in ("symbol", "number"):
                while name in reserved:
                    name += "_"
                reserved.add(name)
                lines += _statement(f"const {real.type} {name}", value, indent)
                value = name
            (stores[argument.name] if late else lines).extend(_statement(target, value, indent))
    return [*lines, "", *(line for a in outputs for line in stores[a.name])] if late else lines


def _computed_in_turn(program: Program) -> list[Argument]:
    """Return the output arguments of a program in the order in which the loop over samples computes them."""
    # for a loop in which each pass computes all results before it stores the first one
    outputs = [a for a in program.signature.arguments if a.role == "out"]
    # all inputs and results fit into registers
    if _streams(program) <= REGISTERS:
        return outputs
    # Fewest inputs first. Measured with gcc 12 on Zen 3 (geometric mean over n = 512, 1000, 1024, 4096, 10^6), this
    # multiplies the time by 0.88 for inertia_tetrahedron, by 0.95 for heavy_top (1.03 at 1000, 0.97 at 10^6) and by
    # 0.98 for heavy_top_symmetric. For two kernels with fewer values, inertia_triangular_prism and inertia_frustum, the
    # factor would be 1.06.
    return sorted(outputs, key=lambda a: _streams(_part(program, a)) - a.size)


def _reserved(program: Program, real: Real) -> set[str]:
    """Return the names that the C code of a batch already uses for arguments, temporaries, functions and loops."""
    arguments = program.signature.arguments
    inputs = {name for a in arguments if a.role == "in" for name, *_ in a.components}
    functions = {*real.functions.values(), *real.near_functions.values()}
    words = {"n", "k", "start", "end", "again", "beyond"}
    return {a.name for a in arguments} | inputs | {name for name, _ in program.temporaries} | functions | words


def _due(needed: set[str], waiting: dict[str, tuple[set[str], list[str]]]) -> list[str]:
    """Take the statements that compute the values ``needed`` out of ``waiting``, and return the lines of C code."""
    # waiting: value -> (names that its statement needs, lines); statements that they need are due too
    for name, (of, _) in reversed(waiting.items()):
        if name in needed:
            needed = needed | of
    return [line for name in [each for each in waiting if each in needed] for line in waiting.pop(name)[1]]


def _silenced(program: Program, indent: str) -> list[str]:
    """Return a statement ``(void)name;`` for each argument that the formulas do not use, to avoid compiler warnings."""
    used = _used(program)
    idle = [
        argument.name
        for argument in program.signature.arguments
        if argument.role == "in" and argument.size and not any(name in used for name, *_ in argument.components)
    ]
    return [f"{indent}(void){name};" for name in idle]


def c_name(kernel: str, real: Real = DOUBLE) -> str:
    """Return the name of a kernel's function in C, such as ``symrot_quaternion_dcm``; with the suffix f for floats."""
    return f"symrot_{kernel}{real.suffix}"


def c_function(program: Program, qualifier: str = "", real: Real = DOUBLE) -> str:
    """Return the C text of the function for one sample, without includes and head comment.

    Parameters
    ----------
    program : Program
        The program to print. Its outputs must not overlap its inputs.
    qualifier : str
        Text in front of the definition, e.g. ``"static inline "``.
    real : Real
        ``DOUBLE`` or ``FLOAT``. The name of a function for floats ends in ``f``.
    """
    head = _head(c_name(program.signature.name, real), c_arguments(program, real), qualifier)
    lines = [head, "{", *_silenced(program, "    "), *_body(program, _index_of_one, "    ", real), "}"]
    return "\n".join(lines) + "\n"


def _own_function(name: str, real: Real) -> list[str]:
    """Return the C definition of a function, such as sinc, that kernels call and <math.h> does not contain."""
    parameters, temporaries, (relation, left, right, then, other) = own_function(name, real.precision)
    arguments = ", ".join(f"{real.type} {parameter}" for parameter in parameters)
    lines = [_head(real.functions[name], arguments, "static inline ", real.type), "{"]
    for temporary, node in temporaries:
        lines += _statement(f"const {real.type} {temporary}", c_expression(node, real), "    ")
    # near x = 0 the limit or a series, elsewhere a quotient such as sin(x)/x
    condition = f"{c_expression(left, real)} {relation} {c_expression(right, real)}"
    return [*lines, f"    return {condition} ? {c_expression(then, real)} : {c_expression(other, real)};", "}", ""]


def _near_function(name: str, real: Real) -> list[str]:
    """Return the C definition of a function that <math.h> lacks, such as sinc, without branches, for batch loops."""
    parameters, temporaries, (relation, left, right, then, other) = own_function(name, real.precision)
    arguments = ", ".join(f"{real.type} {parameter}" for parameter in parameters)
    lines = [_head(real.near_functions[name], arguments, "static inline ", real.type), "{"]
    for temporary, node in temporaries:
        lines += _statement(f"const {real.type} {temporary}", c_expression(node, real, True), "    ")
    # both formulas are evaluated; a bit mask selects one, so that compilers can vectorise the loop
    operands = ", ".join(c_expression(node, real, True) for node in (left, right, then, other))
    return [*lines, f"    return symrot_select_{RELATIONS[relation]}{real.suffix}({operands});", "}", ""]


def _batch_arguments(program: Program, real: Real) -> str:
    parts = ["size_t n"]
    for argument in program.signature.arguments:
        const = "const " if argument.role == "in" else ""
        if argument.name == "p" and argument.size:
            parts.append(_declared(argument, real))
        elif argument.size:
            parts.append(f"{const}{real.type} *SYMROT_RESTRICT {argument.name}")
    return ", ".join(parts)


def _batch(program: Program, real: Real, near: bool) -> list[str]:
    """Return the C text of a program's batch function, which computes n samples."""
    head = [
        _head(f"{c_name(program.signature.name, real)}_batch", _batch_arguments(program, real)),
        "{",
        *_silenced(program, "    "),
    ]
    scalars = [a for a in program.signature.arguments if a.is_scalar and a.role == "in"]
    each = {a.name: f"{a.name}_k" for a in scalars}  # a scalar of one sample is an array in a batch
    used = _used(program)
    loaded = [f"const {real.type} {a.name}_k = {a.name}[k];" for a in scalars if a.components[0][0] in used]
    of_sample = _with_names(program, each)
    angles = turning_arguments(of_sample) if near else []
    parts = _split(program)
    if len(parts) > 1:
        loops = [
            _loop(part, real, ("start", "end"), (), "        ", _stores_last(part), INDEPENDENT, near) for part in parts
        ]
        return [*head, *_blocks(SPAN), *(line for loop in loops for line in loop), "    }", "}"]
    late = _stores_last(program)
    if not angles:
        return [*head, *_loop(of_sample, real, ("0", "n"), loaded, "    ", late, INDEPENDENT, near), "}"]
    # a block of samples with an angle out of the range of symrot_math.h is computed again with <math.h>
    far = " + ".join(f"symrot_far{real.suffix}({c_expression(angle, real, True)})" for angle in angles)
    return [
        *head,
        *_blocks("SYMROT_BLOCK"),
        f"        {real.bits} beyond = 0;",
        *_loop(of_sample, real, ("start", "end"), loaded, "        ", late, INDEPENDENT, near=True)[:-1],
        *_statement("beyond", far, "            ", "+="),
        "        }",
        "        const size_t again = beyond == 0 ? start : end;",
        *_loop(of_sample, real, ("start", "again"), loaded, "        ", late),
        "    }",
        "}",
    ]


def _blocks(size: str) -> list[str]:
    """Return the first C lines of a loop over a batch in blocks of ``size`` samples, from ``start`` to ``end``."""
    return [
        f"    for (size_t start = 0; start < n; start += {size}) {{",
        f"        const size_t end = n - start < {size} ? n : start + {size};",
    ]


def _split(program: Program) -> list[Program]:
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
    used = _used(program)
    moved = [a for a in program.signature.arguments if a.name != "p"]
    return sum(a.role == "out" or name in used for a in moved for name, *_ in a.components)


def _stores_last(program: Program) -> bool:
    """Return whether the loop of a batch computes all results before it stores the first one."""
    # Compilers load values again after a store. If n is a multiple of 512, the arrays of all components fall into one
    # set of the first cache, which holds WAYS of them: with more, the values are no longer in it. Measured with gcc 12
    # on Zen 3 for such n, late stores multiply the time by about 0.9 (heavy_top 0.7, heavy_top_symmetric 1.1), for
    # other n by 1. For 12 arrays (quaternion_product) it would be 1.15 at n = 1000: 26 loads per iteration instead of
    # 22.
    return _streams(program) > WAYS


def _loop(
    program: Program, real: Real, range_: tuple[str, str], loaded: Sequence[str], indent: str, late: bool,
    pragma: str = "", near: bool = False,
) -> list[str]:  # fmt: skip
    start, end = range_
    inner = f"{indent}    "
    return [
        *([f"{indent}{pragma}"] if pragma else []),
        f"{indent}for (size_t k = {start}; k < {end}; ++k) {{",
        *(f"{inner}{line}" for line in loaded),
        *_body(program, _index_in_batch, inner, real, near, late),
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


def _includes(program: Program, near: bool) -> list[str]:
    calls = any(op not in ("add", "mul", "div", "neg") for op in program.operations())
    return [*(["#include <math.h>"] if calls else []), *([f'#include "{MATH_HEADER}"'] if near else [])]


def _prototypes(program: Program, real: Real) -> list[str]:
    name = c_name(program.signature.name, real)
    return [
        f"{_head(name, c_arguments(program, real))};",
        f"{_head(f'{name}_batch', _batch_arguments(program, real))};",
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
        "#else", "#define SYMROT_INDEPENDENT", "#endif", "#endif", "", *(_SPAN if len(_split(program)) > 1 else ()),
        "#ifdef __cplusplus", 'extern "C" {', "#endif",
        "", *shapes, "",
        "#ifdef __cplusplus", "}", "#endif", "", "#endif",
    ]) + "\n"  # fmt: skip


def c_source(program: Program, description: Description, reals: Sequence[Real] = (DOUBLE,), near: bool = False) -> str:
    """Return the C99 text of a kernel, which depends only on the arguments, not on time, paths or the environment.

    Parameters
    ----------
    program : Program
        The kernel.
    description : Description
        Title and other texts for the head comment.
    reals, near
        As for :func:`c_functions`.
    """
    return with_head(program, description, c_functions(program, reals, near))


def with_head(program: Program, description: Description, functions: str) -> str:
    """Return the C file of a kernel: its head comment from ``description``, then ``functions``.

    ``functions`` is the result of :func:`c_functions`.
    """
    return "\n".join([*banner(program, description, "/*", " *", " */"), functions])


def c_functions(program: Program, reals: Sequence[Real] = (DOUBLE,), near: bool = False) -> str:
    """Return the C99 text of a kernel without its head comment.

    Parameters
    ----------
    program : Program
        The kernel.
    reals : sequence of Real
        The types of numbers; for each type a function for one sample and a batch function are printed.
    near : bool
        Whether batches call the functions of ``symrot_math.h``, which compilers vectorise. A block of samples with an
        angle out of the range of these functions is computed again with the C library.
    """
    near = near and has_branch_free_calls(program)
    lines = _includes(program, near)
    lines += [f'#include "{program.signature.name}.h"', ""]
    for real in reals:
        for name in called(program):
            lines += _own_function(name, real)
            if near and name in NEAR:
                lines += _near_function(name, real)
    parts = ["\n".join([c_function(program, real=real), *_batch(program, real, near)]) for real in reals]
    return "\n".join(lines) + "\n" + "\n\n".join(parts) + "\n"
