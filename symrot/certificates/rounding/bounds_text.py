"""Rounding bounds of a library kernel on the standard ranges of its inputs: for its certificate and header comment.

Both texts come from the operations that are read from the C text, so that they agree.
"""

from fractions import Fraction
from functools import lru_cache
from math import frexp
from typing import Any

from symrot.certificates.readback.operations import Operations
from symrot.certificates.rounding.adjoint import LIBM_ULP
from symrot.certificates.rounding.bounds import BUDGET
from symrot.certificates.rounding.library import library_problem, operations_of
from symrot.certificates.rounding.region import UNIT_NORM, Region
from symrot.certificates.rounding.section import region_of, rounding_section
from symrot.errors import InputError
from symrot.kernels.jacobian import BY
from symrot.kernels.library import definition

__all__ = ["bounds_sentence", "library_region", "library_section", "region_phrases", "rounded_up"]

DIGITS = 3  # of a bound in a comment
Section = dict[str, Any]


@lru_cache(maxsize=512)
def _sections(name: str, double: Operations, single: Operations) -> Section | str:
    problem = library_problem(definition(name), double)
    try:
        return rounding_section(double, single, problem.box, problem.region)
    except InputError as reason:
        return str(reason)


def library_section(name: str, source: str) -> Section | str:
    """Return the section ``rounding`` of a library kernel's certificate, or a text that says why it has no bounds.

    Parameters
    ----------
    name : str
        The name of the kernel.
    source : str
        The kernel's C text, with or without the comment at its head.

    Notes
    -----
    A kernel of derivatives, such as ``quaternion_dcm_by_q``, gives a text: it has many outputs, and the search takes
    minutes for some of them, so that its bounds are computed on request only.
    """
    if BY in name:
        return f"{name}: errors of derivatives are bounded on request, by `symrot certify {name} --box NAME=LOW:HIGH`"
    return _sections(name, *operations_of(name, source))


def library_region(name: str, source: str) -> Section:
    """Return the assumptions of a library kernel's error bounds, for the section ``rounding`` of its certificate.

    They are the restrictions of the inputs, the error of libm, and the number of boxes that the search for one output
    may evaluate.
    """
    region = library_problem(definition(name), operations_of(name, source)[0]).region
    return {
        "unit_groups": [list(group) for group in region.unit], "clearance": float(region.clearance).hex(),
        "libm_ulp": float(LIBM_ULP).hex(), "budget": BUDGET,
    }  # fmt: skip


def bounds_sentence(name: str, section: Section | str) -> str:
    """Return a kernel's largest errors as a phrase such as ``on the box at most 1.23e-15 [6.15e-07] rad/s in dq ..``.

    The brackets hold the errors of the function for floats. Without bounds, the phrase is ``no bound; ..``.
    """
    # ``section`` comes from ``library_section``
    if isinstance(section, str):
        return f"no bound; {section.partition(': ')[2]}"
    kernel = definition(name)
    phrases = [
        _result_phrase(section, target.name, sorted({c[1] for c in target.components})) for target, _ in kernel.results
    ]
    turns = any(each["modulo_turns"] for part in section["precisions"] for each in part["outputs"])
    restrictions = [*region_phrases(region_of(section)), *(["angles modulo whole turns"] if turns else [])]
    return f"on the box at most {'; '.join(phrases)} (float functions in brackets){'; '.join(['', *restrictions])}"


def _result_phrase(section: Section, name: str, units: list[str]) -> str:
    """Return the largest errors of an output array for doubles [and floats]: ``1.23e-15 [6.15e-07] rad/s in dq``."""
    double, single = (
        rounded_up(max(
            Fraction(float.fromhex(each["absolute"]))
            for each in part["outputs"] if each["output"].partition("[")[0] == name
        ))
        for part in section["precisions"]
    )  # fmt: skip
    # printed if all components have the same unit
    unit = f" {units[0]}" if len(units) == 1 and units[0] not in ("", "1") else ""
    return f"{double} [{single}]{unit} in {name}"


def rounded_up(value: Fraction, count: int = DIGITS) -> str:
    """Return a number as decimal text, rounded up to ``count`` significant digits, so that a bound stays a bound."""
    if not value:
        return "0"
    exponent = 0
    while Fraction(10) ** (exponent + 1) <= value:
        exponent += 1
    while Fraction(10) ** exponent > value:
        exponent -= 1
    digits = -(-value // Fraction(10) ** (exponent - count + 1))
    if digits == 10**count:
        digits, exponent = digits // 10, exponent + 1
    text = str(digits)
    return f"{text[0]}.{text[1:]}e{exponent:+03d}"


def region_phrases(region: Region) -> list[str]:
    """Return a phrase for each restriction of the inputs, such as ``q[0], q[1]: squares add up to 1, but for 2^-20``.

    This phrase says that the sum of the squares is 1 within 2^-20.
    """
    spare = f"2^{frexp(UNIT_NORM)[1] - 1}"  # exact: a rounded number would claim more than is proven
    phrases = [f"{', '.join(group)}: squares add up to 1, but for {spare}" for group in region.unit]
    if region.clearance:
        phrases.append(f"every atan2 with arguments of length at least {region.clearance:g}")
    return phrases
