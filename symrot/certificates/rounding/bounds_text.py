"""The bounds of a library kernel on its own box: as a section of its certificate, and in words for the head of its C.

The head repeats what the certificate says, so the bounds are those of the operations that are read back from the text
under the head.
"""

from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from math import frexp
from typing import Any

from symrot.certificates.readback.operations import Operations
from symrot.certificates.rounding.adjoint import LIBM_ULP
from symrot.certificates.rounding.bounds import BUDGET, rounding_section
from symrot.certificates.rounding.library import operations_of, problem
from symrot.certificates.rounding.region import UNIT_NORM, Region
from symrot.errors import InputError
from symrot.kernels.library import definition

__all__ = ["in_words", "library_region", "library_section", "region_in_words", "region_of", "rounded_up"]

DIGITS = 3
Section = dict[str, Any]


@lru_cache(maxsize=512)
def _sections(name: str, double: Operations, single: Operations) -> Section | str:
    given = problem(definition(name), double)
    try:
        return rounding_section(double, single, given.box, given.region)
    except InputError as reason:
        return str(reason)


def library_section(name: str, source: str) -> Section | str:
    """Return link 4 of a kernel of the library on its own box; the reason, as text, if it has no bound there.

    Parameters
    ----------
    name : str
        The kernel.
    source : str
        Its C text, with or without its head.
    """
    return _sections(name, *operations_of(name, source))


def library_region(name: str, source: str) -> Section:
    """Return what a section of a kernel says, whatever its box: region, error of libm, budget."""
    region = problem(definition(name), operations_of(name, source)[0]).region
    return {
        "unit_groups": [list(group) for group in region.unit], "clearance": float(region.clearance).hex(),
        "libm_ulp": float(LIBM_ULP).hex(), "budget": BUDGET,
    }  # fmt: skip


def in_words(name: str, source: str) -> str:
    """Return the bounds of a kernel of the library as a sentence without its full stop: largest errors by result."""
    section = library_section(name, source)
    if isinstance(section, str):
        return f"no bound; {section.partition(': ')[2]}"
    found = definition(name)
    said = [_of_result(section, target.name, sorted({c[1] for c in target.components})) for target, _ in found.results]
    turns = any(each["modulo_turns"] for part in section["precisions"] for each in part["outputs"])
    more = [*region_in_words(region_of(section)), *(["angles modulo whole turns"] if turns else [])]
    return f"on the box at most {'; '.join(said)} (float functions in brackets){'; '.join(['', *more])}"


def _of_result(section: Section, name: str, units: list[str]) -> str:
    """Return the largest errors of one result in both precisions."""
    double, single = (
        rounded_up(max(
            Fraction(float.fromhex(each["absolute"]))
            for each in part["outputs"] if each["output"].partition("[")[0] == name
        ))
        for part in section["precisions"]
    )  # fmt: skip
    unit = f" {units[0]}" if len(units) == 1 and units[0] not in ("", "1") else ""
    return f"{double} [{single}]{unit} in {name}"


def rounded_up(value: Fraction) -> str:
    """Return a number in decimal that is not below it, three digits."""
    if not value:
        return "0"
    exponent = 0
    while Fraction(10) ** (exponent + 1) <= value:
        exponent += 1
    while Fraction(10) ** exponent > value:
        exponent -= 1
    digits = -(-value // Fraction(10) ** (exponent - DIGITS + 1))
    if digits == 10**DIGITS:
        digits, exponent = digits // 10, exponent + 1
    text = str(digits)
    return f"{text[0]}.{text[1:]}e{exponent:+03d}"


def region_of(section: Mapping[str, Any]) -> Region:
    """Return the region that a section is about."""
    return Region(tuple(map(tuple, section["unit_groups"])), float.fromhex(section["clearance"]))


def region_in_words(region: Region) -> list[str]:
    """Return what holds on a box beside its sides."""
    spare = f"2^{frexp(UNIT_NORM)[1] - 1}"  # said exactly: rounded up it would be more than what is proven
    found = [f"{', '.join(group)}: squares add up to 1, but for {spare}" for group in region.unit]
    if region.clearance:
        found.append(f"every atan2 with arguments of length at least {region.clearance:g}")
    return found
