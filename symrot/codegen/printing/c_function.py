"""C99 text of a program, which is also valid C++: numbers, expressions, and the function for one sample."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from struct import pack, unpack
from textwrap import wrap

from symrot.codegen.printing.banner import WIDTH
from symrot.codegen.printing.kernel_functions import BRANCH_FREE, turning_arguments
from symrot.formula.program import Argument, Program
from symrot.formula.tree import FUNCTIONS, Node, names, rename, text
from symrot.kernels.removable import FUNCTIONS as OWN_FUNCTIONS

__all__ = [
    "DOUBLE",
    "FLOAT",
    "Real",
    "c_arguments",
    "c_expression",
    "c_function",
    "c_name",
    "declared",
    "function_body",
    "function_head",
    "names_used",
    "silenced",
    "statement",
]


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
    def branch_free_functions(self) -> dict[str, str]:
        """The C names, for this type, of the functions that loops over many samples call: ``sin`` is ``symrot_sin``.

        These are versions without branches, which compilers vectorise. They are defined in ``symrot_math.h`` or printed
        with the kernel, as ``symrot_near_sinc`` is, and are valid for moderate angles only. A function that has no such
        version has the same name as in ``functions``.
        """
        own = {name: f"symrot_near_{name}{self.suffix}" for name in BRANCH_FREE}
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


def c_expression(node: Node, real: Real = DOUBLE, branch_free: bool = False) -> str:
    """Return a formula as a C expression of type ``real``, with brackets that preserve the order of evaluation.

    With ``branch_free``, functions without branches are called, such as ``symrot_sin`` of ``symrot_math.h``: compilers
    vectorise them, but they are valid for moderate angles only.
    """
    return text(rename(node, functions=real.branch_free_functions if branch_free else real.functions), 0, real.literal)


def c_arguments(program: Program, real: Real = DOUBLE) -> str:
    """Return the parameter list of the C function for one sample: ``double t, const double q[4], double dcm[9]``."""
    return ", ".join(declared(argument, real) for argument in program.signature.arguments if argument.size)


def function_head(name: str, arguments: str, qualifier: str = "", returns: str = "void") -> str:
    """Return the head of a C function, such as ``void f(double x)``, with line breaks if it is long."""
    head = f"{qualifier}{returns} {name}({arguments})"
    if len(head) <= WIDTH:
        return head
    unbroken = arguments.replace(", ", ",\0").replace(" ", "\1").replace("\0", " ")  # break after commas only
    lines = wrap(unbroken, WIDTH - 4, break_long_words=False)
    return f"{qualifier}{returns} {name}(\n    " + "\n    ".join(lines).replace("\1", " ") + ")"


def declared(argument: Argument, real: Real) -> str:
    """Return the declaration of an argument as a parameter of the function for one sample: ``const double q[4]``."""
    const = "const " if argument.role == "in" else ""
    size = "" if argument.is_scalar else f"[{argument.size}]"
    return f"{'' if argument.is_scalar else const}{real.type} {argument.name}{size}"


def names_used(program: Program) -> set[str]:
    """Return the names of all inputs and temporaries that occur in the formulas of a program."""
    return set().union(*(names(node) for _, node in program.temporaries + program.outputs))


def statement(head: str, formula: str, indent: str, mark: str = "=") -> list[str]:
    """Return the lines of the C statement ``head = formula;``, broken at blanks if one line is too long.

    ``mark`` is written in place of ``=``, such as ``+=``.
    """
    line = f"{indent}{head} {mark} {formula};"
    if len(line) <= WIDTH + 10:
        return [line]
    return wrap(line, WIDTH + 10, subsequent_indent=f"{indent}    ", break_long_words=False, break_on_hyphens=False)


def _index_of_one(index: int) -> str:
    """Return the C index of component ``index`` of an argument in the function for one sample: the number itself."""
    return str(index)


def function_body(
    program: Program, index_of: Callable[[int], str], indent: str, real: Real, branch_free: bool = False,
    late: Sequence[Argument] = (),
) -> list[str]:  # fmt: skip
    """Return the C statements of a program; a value is computed just before the first output argument that needs it.

    Parameters
    ----------
    program : Program
        The program.
    index_of : callable
        Returns the C index, such as ``2*n + k``, of a component of an argument.
    indent : str
        Text in front of each line.
    real : Real
        The C type of the numbers.
    branch_free : bool
        Whether functions without branches, such as ``symrot_sin`` of ``symrot_math.h``, are called; they are valid for
        moderate angles only.
    late : sequence of Argument
        All output arguments, in the order in which to compute them, if they are to be stored after all of them are
        computed. If empty, each output component is stored as soon as it is computed.
    """
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
                waiting[name] = (set(), [f"{indent}const {real.type} {name} = {argument.name}[{own_index(index)}];"])
    angles = [node[1] for node in turning_arguments(program) if node[1] in waiting]
    waiting = {name: waiting[name] for name in (*angles, *waiting)}  # gcc calls sincos at the place of the angle
    for name, node in program.temporaries:
        statements = statement(f"const {real.type} {name}", c_expression(node, real, branch_free), indent)
        waiting[name] = (names(node), statements)
    outputs = [a for a in program.signature.arguments if a.role == "out"]
    for argument in late or outputs:
        due = _due(set().union(*(names(results[name]) for name, *_ in argument.components)), waiting)
        lines += [*([""] if due and lines else []), *due, *([""] if due else [])]
        for index, (name, *_) in enumerate(argument.components):
            target, value = f"{argument.name}[{index_of(index)}]", c_expression(results[name], real, branch_free)
            if late and results[name][0] not in ("symbol", "number"):
                while name in reserved:
                    name += "_"
                reserved.add(name)
                lines += statement(f"const {real.type} {name}", value, indent)
                value = name
            (stores[argument.name] if late else lines).extend(statement(target, value, indent))
    return [*lines, "", *(line for a in outputs for line in stores[a.name])] if late else lines


def _reserved(program: Program, real: Real) -> set[str]:
    """Return the names that the C code of a batch already uses for arguments, temporaries, functions and loops."""
    arguments = program.signature.arguments
    inputs = {name for a in arguments if a.role == "in" for name, *_ in a.components}
    functions = {*real.functions.values(), *real.branch_free_functions.values()}
    words = {"n", "k", "start", "end", "again", "beyond"}
    return {a.name for a in arguments} | inputs | {name for name, _ in program.temporaries} | functions | words


def _due(needed: set[str], waiting: dict[str, tuple[set[str], list[str]]]) -> list[str]:
    """Remove the statements that compute the values ``needed`` from ``waiting``, and return their lines of C code.

    ``waiting`` maps the name of each value that is not yet computed to a pair: the names that its statement needs, and
    the lines of the statement. If a removed statement needs other values in ``waiting``, their statements are removed
    too.
    """
    for name, (of, _) in reversed(waiting.items()):
        if name in needed:
            needed = needed | of
    return [line for name in [each for each in waiting if each in needed] for line in waiting.pop(name)[1]]


def silenced(program: Program, indent: str) -> list[str]:
    """Return a statement ``(void)name;`` for each input that the formulas do not use, to avoid compiler warnings."""
    used = names_used(program)
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
    head = function_head(c_name(program.signature.name, real), c_arguments(program, real), qualifier)
    lines = [head, "{", *silenced(program, "    "), *function_body(program, _index_of_one, "    ", real), "}"]
    return "\n".join(lines) + "\n"
