"""NumPy text of programs: a function that computes one sample, or arrays of samples along the last axis."""

from fractions import Fraction

from symrot.codegen.printing.banner import Description, banner
from symrot.codegen.printing.kernel_functions import called, own_function, unpacked
from symrot.formula.program import Program
from symrot.formula.tree import FUNCTIONS as KNOWN
from symrot.formula.tree import Node, names, rename, text
from symrot.kernels.removable import FUNCTIONS as OWN_FUNCTIONS
from symrot.kernels.removable import REMOVABLE

__all__ = ["numpy_source"]

FUNCTIONS = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2"}


def _literal(value: Fraction) -> str:
    return repr(float(value))


def _expression(node: Node) -> str:
    return text(rename(node, functions=_NAMES), 0, _literal)


_NAMES = {name: f"np.{FUNCTIONS.get(name, name)}" for name in KNOWN} | {name: f"_{name}" for name in OWN_FUNCTIONS}
_NAMES["copysign"] = "np.copysign"


def _own_function(name: str) -> list[str]:
    """Return the Python definition of a function, such as sinc, that NumPy lacks."""
    parameters, temporaries, (relation, left, right, then, other) = own_function(name, "binary64")
    condition = f"{_expression(left)} {relation} {_expression(right)}"
    high = name in REMOVABLE and REMOVABLE[name].power > 3  # its quotient overflows next to zero, where it is not used
    ignored = 'divide="ignore", invalid="ignore"' + (', over="ignore"' if high else "")
    return [
        "", "", f"@np.errstate({ignored})", f"def _{name}({', '.join(parameters)}):",
        *(f"    {temporary} = {_expression(node)}" for temporary, node in temporaries),
        # both formulas are evaluated on the whole array, also where the other one is used
        f"    return np.where({condition}, {_expression(then)}, {_expression(other)})",
    ]  # fmt: skip


def numpy_source(program: Program, description: Description) -> str:
    """Return the text of a Python module with one NumPy function, which computes a kernel for one or n samples."""
    inputs = [a for a in program.signature.arguments if a.role == "in" and a.size]
    outputs = [a for a in program.signature.arguments if a.role == "out"]
    used = set().union(*(names(node) for _, node in program.temporaries + program.outputs))
    shape = next(a.name for a in inputs if not a.is_scalar and a.name != "p")
    results = dict(program.outputs)
    lines = [*banner(program, description, '"""', "", '"""')]
    lines = [lines[0] + lines[1].strip(), *(line[1:] if line.startswith(" ") else line for line in lines[2:])]
    lines += ["", "import numpy as np"]
    lines += [line for name in called(program) for line in _own_function(name)]
    lines += ["", "", f"def {program.signature.name}({', '.join(a.name for a in inputs)}):"]
    lines += [unpacked(argument, used) for argument in inputs if not argument.is_scalar]
    lines += [f"    {name} = {_expression(node)}" for name, node in program.temporaries]
    for argument in outputs:
        lines.append(f"    {argument.name} = np.empty(({argument.size}, *np.shape({shape})[1:]))")
        lines += [
            f"    {argument.name}[{index}] = {_expression(results[name])}"
            for index, (name, *_) in enumerate(argument.components)
        ]
    lines.append(f"    return {', '.join(a.name for a in outputs)}")
    return "\n".join(lines) + "\n"
