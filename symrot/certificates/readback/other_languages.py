"""The check that a kernel's text in another language performs the same operations as its C text.

A text in JavaScript or JAX is rewritten as C and read; its operations are compared with those of the C file.
"""

from collections.abc import Callable

from symrot.certificates.readback.c_functions import CFunction, functions_of
from symrot.certificates.readback.readback import read_kernel
from symrot.errors import CertificateError

__all__ = ["AsC", "compare_operations", "kernel_head"]

AsC = Callable[[str, str, CFunction, str], str]
"""(text of a module, name of its kernel, C function of that kernel, name of the file) -> C text of the same meaning."""


def compare_operations(as_c: AsC, text: str, name: str, c_text: str, where: str) -> None:
    """Raise CertificateError unless a kernel performs the same operations as the C function for doubles.

    Parameters
    ----------
    as_c : function
        Rewrites the text as C; raises CertificateError for a text that symrot does not emit.
    text : str
        A module as symrot emits it.
    name : str
        Name of the kernel's function in the module; the C function has this name with the prefix ``symrot_``.
    c_text : str
        The C text of the same kernel.
    where : str
        The file's name, for errors.
    """
    function = f"symrot_{name}"
    model = functions_of(c_text, where).get(function)
    if model is None:
        raise CertificateError(f"{where}: expected C text with the function {function}")
    # same constants, same functions, same order of rounding
    if read_kernel(as_c(text, name, model, where), function, where) != read_kernel(c_text, function, where):
        raise CertificateError(
            f"{where}: expected the same operations as in the C function {function}, got other operations"
        )


def kernel_head(model: CFunction) -> str:
    """Return the head of the C function ``model``: ``void symrot_NAME(const double x[3], double y[3])``."""
    declared = [
        f"{'const ' * (bool(p.size) and p.is_const)}double {p.name}" + (f"[{p.size}]" if p.size else "")
        for p in model.parameters
    ]
    return f"void {model.name}({', '.join(declared)})"
