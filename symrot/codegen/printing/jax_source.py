"""JAX text of programs: a pure function for one sample, for ``jax.jit``, ``jax.vmap`` and ``jax.grad``.

The statements are those of the C text, in the same order, so that both compute the same operations.
"""

from keyword import kwlist

from symrot.codegen.printing.banner import Description, banner
from symrot.codegen.printing.kernel_functions import called, own_function, unpacked
from symrot.codegen.printing.safe_names import with_safe_names
from symrot.formula.program import Program
from symrot.formula.tree import FUNCTIONS, Node, names, rename, text
from symrot.kernels.removable import FUNCTIONS as OWN_FUNCTIONS

__all__ = ["jax_source"]

_ARRAY_NAMES = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2"}
_NAMES = {name: f"jnp.{_ARRAY_NAMES.get(name, name)}" for name in FUNCTIONS} | {
    name: f"_{name}" for name in OWN_FUNCTIONS
}
_NAMES["copysign"] = "jnp.copysign"

SLOPES = {"sinc": "tangent_gap", "sine_gap": "sine_bend", "tangent_gap": "tangent_bend"}
"""Each function f whose derivative is ``-x*g(x)``, with the name of g; see :mod:`symrot.kernels.removable`."""

RESERVED = frozenset({*kwlist, "jax", "jnp", *_NAMES.values()})
"""Names that no variable of a program may have in its JAX text: words of Python, jax, jnp and called functions."""

_JVP = """

@_{name}.defjvp
def _{name}_jvp(primals, tangents):
    (x,), (dx,) = primals, tangents
    return _{name}(x), -x*_{slope}(x)*dx\
"""


def _literal(value: object) -> str:
    return repr(float(value))  # type: ignore[arg-type]


def _expression(node: Node) -> str:
    return text(rename(node, functions=_NAMES), 0, _literal)


def _needed(program: Program) -> list[str]:
    """Return the functions, such as sinc, that JAX lacks and the text of a program must define."""
    # the called functions, and the functions in their derivatives
    needed = dict.fromkeys(called(program))
    for name in SLOPES:  # each is before its derivative
        if name in needed:
            needed[SLOPES[name]] = None
    return [name for name in OWN_FUNCTIONS if name in needed]


def _own_function(name: str) -> list[str]:
    """Return the definition of a function, such as sinc, that JAX lacks."""
    parameters, temporaries, (relation, left, right, then, other) = own_function(name, "binary64")
    condition = f"{_expression(left)} {relation} {_expression(right)}"
    # custom_jvp tells JAX the formula of the derivative; without one, JAX differentiates the definition
    slope = SLOPES.get(name)
    return [
        "", "", *(["@jax.custom_jvp"] if slope else []), f"def _{name}({', '.join(parameters)}):",
        *(f"    {temporary} = {_expression(node)}" for temporary, node in temporaries),
        f"    return jnp.where({condition}, {_expression(then)}, {_expression(other)})",
        *(_JVP.format(name=name, slope=slope).split("\n") if slope else []),
    ]  # fmt: skip


def jax_source(program: Program, description: Description) -> str:
    """Return the text of a Python module with one JAX function, which returns an array for each output argument."""
    # the same program gives the same bytes
    program = with_safe_names(program, RESERVED)
    inputs = [a for a in program.signature.arguments if a.role == "in" and a.size]
    outputs = [a for a in program.signature.arguments if a.role == "out" and a.size]
    used = set().union(*(names(node) for _, node in program.temporaries + program.outputs))
    needed, results = _needed(program), dict(program.outputs)
    first, title, *rest = banner(program, description, '"""', "", '"""')
    lines = [first + title.strip(), *(line.removeprefix(" ") for line in rest), ""]
    lines += [*(["import jax"] if SLOPES.keys() & set(needed) else []), "import jax.numpy as jnp"]
    lines += [line for name in needed for line in _own_function(name)]
    lines += ["", "", f"def {program.signature.name}({', '.join(a.name for a in inputs)}):"]
    lines += [unpacked(argument, used) for argument in inputs if not argument.is_scalar]
    lines += [f"    {name} = {_expression(node)}" for name, node in program.temporaries]
    for argument in outputs:
        lines.append(f"    {argument.name} = jnp.stack([")
        lines += [f"        {_expression(results[name])}," for name, *_ in argument.components]
        lines.append("    ])")
    lines.append(f"    return {', '.join(a.name for a in outputs)}")
    return "\n".join(lines) + "\n"
