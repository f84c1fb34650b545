"""C header with the values of a time step's parameters in one scene, in the order of the step's argument p."""

from collections.abc import Sequence

__all__ = ["parameters_file", "parameters_header"]


def parameters_file(name: str) -> str:
    """Return the file name of the C header with the parameters of the step ``name``."""
    return f"{name}_parameters.h"


def parameters_header(name: str, parameters: Sequence[tuple[str, float]]) -> str:
    """Return the text of a header that defines the array ``symrot_NAME_parameters``.

    Parameters
    ----------
    name : str
        Name of the emitted time step, such as ``t_handle_rk4_step``.
    parameters : sequence of (str, float)
        Names and values, in the order of the step's C argument p, the array of parameters.
    """
    guard = f"SYMROT_{name.upper()}_PARAMETERS_H"
    return "\n".join([
        f"/* The parameters p of {name}: values of the scene; {name}.c has their formulas. Printed by symrot. */",
        f"#ifndef {guard}", f"#define {guard}", "",
        f"static const double symrot_{name}_parameters[{len(parameters)}] = {{",
        *(f"    {value!r}, /* {symbol} */" for symbol, value in parameters), "};", "", "#endif",
    ]) + "\n"  # fmt: skip
