"""The check that the header of an emitted kernel contains only fixed lines and the prototypes of its C file.

A header can change what a C file means; a macro called ``sin`` is enough. So every line outside comments must be one
of the constants ``_TOP`` to ``_END``, in this order, or part of a prototype. Another included header, or a function
with the name of one in the C library, can change the meaning too, so the C file of a step is checked to contain nothing
but the functions of the step.
"""

import re

from symrot.errors import CertificateError

__all__ = ["check_header", "check_source"]

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_TOP = """
#ifndef {guard}
#define {guard}
#include <stddef.h>
#ifndef SYMROT_RESTRICT
#ifdef __cplusplus
#define SYMROT_RESTRICT __restrict
#else
#define SYMROT_RESTRICT restrict
#endif
#endif
"""
_INDEPENDENT = """
#ifndef SYMROT_INDEPENDENT
#if defined(__clang__) && defined(__NO_MATH_ERRNO__)
#define SYMROT_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__) && !defined(__clang__)
#define SYMROT_INDEPENDENT _Pragma("GCC ivdep")
#else
#define SYMROT_INDEPENDENT
#endif
#endif
"""
_SPAN = """
#ifndef SYMROT_SPAN
#define SYMROT_SPAN 2048
#endif
"""
_OPEN = """
#ifdef __cplusplus
extern "C" {
#endif
"""
_END = """
#ifdef __cplusplus
}
#endif
#endif
"""


def check_header(header: str, source: str, name: str) -> None:
    """Raise CertificateError if a header contains anything but the fixed lines and the prototypes of its C file.

    Parameters
    ----------
    header, source : str
        The texts of NAME.h and NAME.c.
    name : str
        The name of the kernel.

    Raises
    ------
    CertificateError
        If a line is unexpected, or a function has no prototype, or a prototype no function; the message names one.
    """
    if re.search(r"\\|\?\?|[\0-\x09\x0b-\x1f]", header):
        raise CertificateError(
            f"{name}.h: expected a header without backslash, trigraph or control character, got such a character"
        )
    lines = [line.strip() for line in _COMMENT.sub(" ", header).split("\n")]
    lines = [line for line in lines if line]
    top, end = _lines(_TOP.format(guard=f"SYMROT_{name.upper()}_H")), _lines(_END)
    for optional in map(_lines, (_INDEPENDENT, _SPAN)):
        top += optional if lines[len(top) : len(top) + 1] == optional[:1] else []
    top += _lines(_OPEN)
    for got, fixed in zip(lines, top, strict=False):
        if got != fixed:
            raise CertificateError(f"{name}.h: expected the line {fixed!r}, got {got[:80]!r}")
    middle = lines[len(top) : len(lines) - len(end)]
    if len(lines) < len(top) + len(end) or lines[len(lines) - len(end) :] != end:
        raise CertificateError(f"{name}.h: expected the lines {' '.join(end)!r} at the end, got others")
    if directive := next((line for line in middle if "#" in line), ""):
        raise CertificateError(
            f'{name}.h: expected nothing but prototypes inside extern "C" {{ }}, got the line {directive[:80]!r}'
        )
    declared = {_words(each) for each in " ".join(middle).split(";") if each.strip()}
    defined = {_words(head) for head in re.findall(r"^(void \w+\([^()]*\))\s*\{", _COMMENT.sub(" ", source), re.M)}
    if declared != defined:
        odd = sorted(declared ^ defined)[0]
        raise CertificateError(f"{name}.h: expected the same functions as in {name}.c, but {odd!r} differs")


def check_source(source: str, name: str) -> None:
    """Raise CertificateError if a C file contains anything but the functions of a step and the includes they need.

    These are <math.h> and the step's header, which must be included.

    Parameters
    ----------
    source : str
        The text of NAME.c.
    name : str
        The name of the step.
    """
    if odd := re.search(r"\\|\?\?|//|[\0-\x09\x0b-\x1f]", source):
        raise CertificateError(
            f"{name}.c: expected C without backslash, trigraph, // or control character, got {odd[0]!r}"
        )
    guard, lines = f"SYMROT_{name.upper()}_H", _COMMENT.sub(" ", source).split("\n")
    for line in (line.strip() for line in lines if "#" in line):
        if line not in ("#include <math.h>", f'#include "{name}.h"'):
            raise CertificateError(f"{name}.c: expected no #include but <math.h> and {name}.h, got {line[:80]!r}")
    if not any(line.strip() == f'#include "{name}.h"' for line in lines):
        raise CertificateError(f"{name}.c: expected #include of {name}.h, got none")
    code = " ".join(line for line in lines if "#" not in line)
    if re.search(rf"\b{guard}\b", code):
        raise CertificateError(
            f"{name}.c: expected no use of {guard}, the include guard of {name}.h, outside comments, got one"
        )
    calls = re.findall(r"\b(?!symrot_|for\b)[a-z]\w*\s*\((?!\s*void\b)", code)
    blocks = 1
    while blocks:  # the innermost first
        code, blocks = re.subn(r"\{[^{}]*\}", "@", code)
    *heads, end = (" ".join(head.split()) for head in code.split("@"))
    own = rf"void symrot_{name}f?(_batch)?\([^()]*\)|static inline (double|float) symrot_\w+\([^()]*\)"
    for head in (*heads, *[end] * bool(end)):
        if head == end or not re.fullmatch(own, head):
            raise CertificateError(
                f"{name}.c: expected only functions that belong to the step, such as symrot_{name}, got {head[:80]!r}"
            )
    if calls and "#include <math.h>" not in source:
        raise CertificateError(f"{name}.c: expected #include <math.h> for {calls[0]}..), got none")


def _lines(text: str) -> list[str]:
    return text.strip().split("\n")


def _words(text: str) -> str:
    return " ".join(re.sub(r"([(),*])", r" \1 ", text).split())
