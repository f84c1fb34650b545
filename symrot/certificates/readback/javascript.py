"""The reader of emitted JavaScript: it rewrites the text as C with the same meaning, which readback.py reads.

Kernels in JavaScript use few words, so that replacing them gives C; other JavaScript is refused. Array sizes come from
the C function of the same kernel. This module shares no code with the emitter. In all its functions, the argument
``where`` is the name of the file, for error messages.
"""

import re

from symrot.certificates.readback.c_functions import CFunction
from symrot.certificates.readback.other_languages import compare_operations, kernel_head
from symrot.errors import CertificateError

__all__ = ["compare_javascript"]

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_TOKEN = re.compile(
    r"\s+|\d[\w.]*(?:(?<=[eE])[+-]\d+)?|[A-Za-z_]\w*(?:\.[a-z]\w*)?|===|[-+*/()\[\]{},;=<>?:]", re.ASCII
)
_HEAD = re.compile(r"(?:export )?function (\w+)\(([\w, ]*)\) \{", re.ASCII)
_LENGTH_CHECK = (
    "    if ({0}.length !== {1}) throw new RangeError(`{0}: expected {1} number{2}, got ${{{0}.length}}`);\n"
)
_COPYSIGN = "function copysign(x, y) {\n    return (y < 0 || Object.is(y, -0) ? -1 : 1)*Math.abs(x);\n}\n"
_MATH = {
    f"Math.{name}": name
    for name in ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "log", "sinh", "cosh", "tanh")
} | {"Math.abs": "fabs"}
_ONLY_IN_C = ("double", "float", "fabs", "symrot_", "void", "static", "inline", "size_t", *_MATH.values())


def compare_javascript(text: str, name: str, c_text: str, where: str = "kernel") -> None:
    """Raise CertificateError unless a JavaScript kernel performs the same operations as the C function for doubles."""
    compare_operations(_as_c, text, name, c_text, where)


def _as_c(text: str, name: str, model: CFunction, where: str) -> str:
    """Return a JavaScript module as C text with the same meaning; ``model`` is the kernel's C function."""
    body = _COMMENT.sub(" ", text).replace(_COPYSIGN, "")
    parts = _HEAD.split(body)
    if parts[0].strip() or len(parts) < 4:
        raise CertificateError(f"{where}: expected a JavaScript module that contains only functions")
    functions = []
    for function, arguments, content in zip(parts[1::3], parts[2::3], parts[3::3], strict=True):
        names = arguments.split(", ") if arguments else []
        if function == name:
            head = _kernel_head(names, model, where)
            content = _without_length_checks(content, model, where)
        else:
            head = f"static inline double {function}({', '.join(f'double {each}' for each in names)})"
        functions.append(f"{head}\n{{{_translated(content, where)}")
    return "\n".join(functions)


def _kernel_head(names: list[str], model: CFunction, where: str) -> str:
    """Return the C line ``void NAME(..)`` that replaces the first line of a JavaScript kernel.

    ``names`` are the arguments in JavaScript. CertificateError is raised unless they are those of ``model``, the C
    function of the same kernel.
    """
    expected = [parameter.name for parameter in model.parameters]
    if names != expected:
        raise CertificateError(f"{where}: expected the arguments {', '.join(expected)}, got {', '.join(names)}")
    return kernel_head(model)


def _without_length_checks(content: str, model: CFunction, where: str) -> str:
    """Return the body of a kernel without its first lines, which must check the lengths of the inputs of ``model``."""
    content = content.removeprefix("\n")
    for name, size in ((p.name, p.size) for p in model.parameters if p.size and p.is_const):
        check = _LENGTH_CHECK.format(name, size, "s" if size > 1 else "")
        if not content.startswith(check):
            raise CertificateError(f"{where}: expected a check that {name} has {size} numbers, got {content[:40]!r}")
        content = content.removeprefix(check)
    return content


def _translated(content: str, where: str) -> str:
    """Return the body of a JavaScript function as C, such as ``sin(x)`` for ``Math.sin(x)``."""
    place, words = 0, []
    while place < len(content):
        match = _TOKEN.match(content, place)
        if match is None:
            raise CertificateError(
                f"{where}: expected JavaScript as symrot emits it, got {content[place : place + 20]!r}"
            )
        word, place = match[0], match.end()
        if word in _MATH:
            word = _MATH[word]
        elif "." in word and not word[0].isdigit():
            raise CertificateError(f"{where}: expected a function of Math that kernels use, got {word}")
        # emitted JavaScript does not contain, for example, types of C
        elif word in _ONLY_IN_C or word.startswith("symrot_"):
            raise CertificateError(f"{where}: expected JavaScript as symrot emits it, got the word {word}")
        elif word == "const":
            word = "const double"
        elif word == "===":
            word = "=="
        words.append(word)
    return "".join(words)
