"""Claims whose formula lacks a term or a factor of the formula that the context of the claim states.

The lacking term or factor has letters of its own, as k*x in ``m*g*l + k*x``.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from itertools import islice
from typing import Any

from sympy import Expr, Symbol, cancel

from symrot.checker.claim.interpreter import atoms_of, time
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.tree import text
from symrot.checker.recognition.known_formulas import Known
from symrot.checker.recognition.single_faults.absent_names import absent_name
from symrot.checker.repair.edits.faults import COST, FAULT_DESCRIPTIONS
from symrot.checker.verdict import Diagnosis, Identification, Repair, Verdict
from symrot.exact.decide import decide
from symrot.exact.printing import as_text

__all__ = ["with_lacking_letters"]

LEAST_LETTERS = 2
"""The smallest number of letters of a claim's formula that is compared with derived formulas."""
MOST_ASSIGNMENTS = 6
"""The largest number of assignments of a claim's letters to the symbols of one derived formula that are tried."""

Assignments = Callable[[Known, Any, set[Expr]], Iterator[Mapping[Expr, Expr]]]


def with_lacking_letters(
    named: NamedFormula, value: Any, meant: Iterator[tuple[Known, Any]], assignments: Assignments
) -> Verdict | None:
    """Return the verdict "doubtful" if a derived formula has one term or factor more than the claim's formula.

    For instance, the claim has ``m*g*l`` and the derived formula ``m*g*l*sin(theta)``. ``meant`` are the derived
    formulas for what the context states in words; ``assignments`` yields maps from the symbols of a derived formula to
    letters of the claim. Return None if no such formula has one more term or factor.
    """
    own = {*atoms_of([value])} - {time}
    if is_matrix(value) or len(own) < LEAST_LETTERS:
        return None
    for known, target in meant:
        if is_matrix(target):
            continue
        symbols = target.free_symbols - {time}
        if len(own) >= len(symbols):
            continue
        # each mapping assigns letters of the claim to the symbols of the derived formula
        for mapping in islice(assignments(known, target, own), MOST_ASSIGNMENTS):
            code = _fault(target.xreplace(dict(mapping)), value, symbols - {*mapping})
            if code:
                return _verdict(named, known, target, mapping, code)
    return None


def _fault(target: Expr, value: Expr, lacking: set[Expr]) -> str:
    """Return the fault of a claim that lacks a term ("missing_term") or a factor ("factor"); "" for any other fault.

    ``value`` is the claimed formula, ``target`` the known one, and ``lacking`` the symbols of ``target`` for which the
    claim has no letter.
    """
    # m*g*l lacks a term of m*g*l + k*x: both are equal for k = 0, and k is not in the claim
    for symbol in sorted(lacking, key=str):
        rest = target.subs(symbol, 0)
        if not rest.has(symbol) and rest.is_finite is not False and decide(rest, value).verdict == "true":
            return "missing_term"
    # m*v lacks a factor of m*v*r: the quotient has only letters that are not in the claim
    quotient = cancel(target / value)
    return "factor" if quotient.free_symbols and quotient.free_symbols <= lacking else ""


def _verdict(named: NamedFormula, known: Known, target: Expr, mapping: Mapping[Expr, Expr], code: str) -> Verdict:
    names = {old.name: as_text(new) for old, new in mapping.items() if isinstance(old, Symbol)}
    renaming: dict[str, str | None] = dict(names)
    for old, new in names.items():
        if old.startswith("d") and (rate := re.match(r"diff\((\w+)", new)):
            renaming[old[1:]] = rate[1]  # domega_3 for diff(omega_z(t), t): omega_z is the name of omega_3
    others = {symbol: Symbol(absent_name(symbol.name, renaming)[0], real=True)
              for symbol in target.free_symbols - {*mapping} - {time}}  # fmt: skip
    whole = as_text(target.xreplace({**others, **mapping}))
    repair = Repair(f"{text(named.side)} == {whole}", code, COST["missing_term"])
    own = {old: new for old, new in names.items() if old != new}
    return Verdict(
        "doubtful", diagnosis=Diagnosis(code, FAULT_DESCRIPTIONS[code]), repairs=(repair,),
        recognised_as=(Identification(known.name, "", own, known.source),),
    )  # fmt: skip
