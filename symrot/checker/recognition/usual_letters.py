"""The letters that books use for quantities: the unit of a symbol by its name, and the letters for a unit."""

import re
from functools import lru_cache

from symrot import symbols
from symrot.checker.recognition.formulas.new_symbols import UNIT_OF_SYMBOL
from symrot.checker.units.units import conventional_unit

__all__ = ["LETTERS", "UNIT_OF_NAME", "agree_in_unit", "has_usual_letter", "plain_name", "unit_of"]

UNIT_OF_NAME = {symbol.name: unit for symbol, unit in (symbols.UNIT | UNIT_OF_SYMBOL).items()}
"""Name of a symbol in known formulas -> its unit."""

LETTERS = {
    "kg m^2": r"[ABCIJ]\w*|lambda_?[1-3]", "kg": r"[mM]\w*", "N": r"[WPFG]\w*",
    "N, of a string": r"[TSF](_\w+)?", "m": r"[a-hlrsxyzLRD]\w*|ell",
    "kg m^2/s": r"[LHGhpM]\w*",
    "kg m/s": r"[pP]\w*", "N m, of momentum": r"d[LHhM]\w*",
    "N m": r"(M|N|T|Q|tau|Gamma)(_\w+)?|K_?[1-3xyz]",
    "rad/s": r"(omega|w|Omega|n|nu|p|q|r|s|S|lambda)(_?\w+)?|d(phi|theta|psi|alpha|beta|gamma)(_?[1-3])?",
    "rad/s^2": r"alpha\w*|d(omega|w|Omega)\w*|dd\w+|d[pqr]", "m/s": r"[vuV]\w*", "m/s^2": r"[ga]\w*",
    "s": r"[tTP]\w*|tau|Delta_t", "J": r"[ETKVUW]\w*", "N m/rad": r"(k|c|kappa)(_\w+)?", "m, of gyration": r"[kri]\w*",
    "1": r"([nkeulqpsgcabdr]|beta|eps|epsilon|varepsilon|eta|xi|rho|sigma|gamma|lambda|mu|[RACQ]_?[0-9])\w*",
}  # fmt: skip
"""Unit -> pattern of the letters that books use for quantities with this unit, such as m or M for a mass in kg."""


def has_usual_letter(known: str, own: str) -> bool:
    """Return whether ``own`` is a usual letter in books for a quantity with the unit of ``known``: M for the mass m.

    ``known`` is a symbol of a known formula. True also if its unit is unknown or has no entry in ``LETTERS``.
    """
    pattern = LETTERS.get(UNIT_OF_NAME.get(known, ""))
    return pattern is None or re.fullmatch(pattern, plain_name(own)) is not None


@lru_cache(maxsize=20_000)
def plain_name(name: str) -> str:
    """Return the plain name of a quantity: x for ``x(t)``, dx for ``diff(x(t), t)`` and ``x_dot``."""
    rate = re.fullmatch(r"diff\((\w+)(\(t\))?((, t)+)\)", name)
    if rate is None and (dots := re.fullmatch(r"(\w+?)_(d*)dot", name)) is not None:
        return f"d{dots[2]}{dots[1]}"
    return "d" * rate[3].count("t") + rate[1] if rate else name.removesuffix("(t)")


@lru_cache(maxsize=20_000)
def unit_of(name: str) -> str | None:
    """Return the conventional unit of a symbol, or None if books use the symbol for different quantities."""
    name = plain_name(name)
    if re.fullmatch(r"[ABC]", name):
        return "kg m^2"
    return "1" if re.fullmatch(r"[qp][0-3]", name) else conventional_unit(name)


def agree_in_unit(known: str, own: str) -> bool:
    """Return whether a claim's symbol ``own`` may have the unit of ``known``, a symbol of a known formula."""
    unit, conventional = UNIT_OF_NAME.get(known), unit_of(own)
    # books use some letters for different quantities
    return unit is None or conventional is None or conventional == unit
