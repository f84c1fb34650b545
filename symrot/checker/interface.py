"""``check`` and ``check_file``: a claim in, a verdict out."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import Any

from symrot.checker.claims import Claim, claim_of_text, read_claims
from symrot.checker.decision import Problem, decide_problem, shown
from symrot.checker.dimensions import check_dimensions, dimensions_of_formulas
from symrot.checker.values import decide_value
from symrot.checker.verdict import Diagnosis, Verdict
from symrot.errors import InputError

__all__ = ["check", "check_claim", "check_file"]


def check(
    left: Any,
    right: Any = None,
    *,
    assume: Sequence[Any] = (),
    units: Mapping[str, str] | None = None,
    repair: bool = True,
) -> Verdict:
    """Return the verdict on an equation.

    Parameters
    ----------
    left : str, Expr or Matrix
        The whole claim as text, ``"left == right"`` in the language of claims or LaTeX (text with a backslash): names
        are real symbols, ``phi(t)`` is a function of time. Or the left side as a SymPy expression or matrix.
    right : Expr or Matrix, optional
        The right side, with a left side of SymPy.
    assume : sequence
        Hypotheses: texts ``"a == b"``, ``"x > 0"``, ``"x != 0"`` for a text; equations, or expressions that are zero,
        for SymPy.
    units : mapping of str to str, optional
        Units by the name of a symbol, ``{"x": "m"}``; others are those of custom (``I1``, ``omega_1``, ``g``, ``t``,
        ``phi``), of the symbols of symrot, or inferred. They bear on ``.dimension`` alone.
    repair : bool
        Whether to look for what went wrong with a claim that is not true, and for true formulas near it.

    Returns
    -------
    Verdict
        ``.verdict`` is ``"true"``, ``"false"``, ``"conditional"`` or ``"undecided"``; ``.dimension`` says beside it
        whether the units fit.

    Raises
    ------
    InputError
        For text that is not understood (with its position), undefined names, shapes that do not fit, and divisions by
        what is zero everywhere. Nothing is evaluated as Python.

    Examples
    --------
    >>> check("cos(2*x) == 1 - 2*sin(x)**2").verdict
    'true'
    """
    if isinstance(left, str):
        if right is not None:
            raise InputError("expected the whole claim 'left == right' as one text, got two arguments")
        if isinstance(assume, str) or not all(isinstance(hypothesis, str) for hypothesis in assume):
            raise InputError("assume: expected a list of texts like 'a == b' beside a claim as text")
        return check_claim(claim_of_text(left, assume, units or {}), repair)
    if right is None:
        raise InputError("expected two sides, or one text 'left == right'")
    start = perf_counter()
    decision = decide_problem(Problem(left, right, tuple(assume)))
    verdict = _verdict(decision, f"{shown(left)} == {shown(right)}", start)
    return replace(verdict, dimension=dimensions_of_formulas(left, right, units))


def check_file(path: str | Path, *, repair: bool = True) -> list[Verdict]:
    """Return the verdicts on the claims of a TOML file, in its order.

    Raises
    ------
    InputError
        As :func:`check`, naming the file and the claim; the whole file is read before anything is decided.
    """
    return [check_claim(claim, repair) for claim in read_claims(path)]


def check_claim(claim: Claim, repair: bool = True) -> Verdict:
    """Return the verdict on a claim that has been read."""
    start = perf_counter()
    try:
        decision = decide_value(claim) if claim.relation is None else decide_problem(claim.problem())
    except InputError as reason:
        if not claim.id or claim.id in str(reason):
            raise
        raise InputError(f"{claim.id}: {reason}") from None
    verdict = _verdict(decision, claim.text, start)
    if claim.relation is not None:
        hypotheses = [relation[1:] for relation in claim.given]
        verdict = replace(
            verdict, dimension=check_dimensions(claim.relation[1:], claim.define, hypotheses, claim.units)
        )
    if repair and claim.relation is not None and decision.verdict in ("false", "conditional"):
        from symrot.checker.diagnose import diagnose

        diagnosis, repairs = diagnose(claim, decision)
        if diagnosis.code == "none" and verdict.dimension.status == "inconsistent":
            diagnosis = Diagnosis("dimension", f"the units do not fit: {verdict.dimension.text}")
        verdict = replace(verdict, diagnosis=diagnosis, repairs=repairs)
    return replace(verdict, id=claim.id, where=claim.where, seconds=perf_counter() - start)


def _verdict(decision: Any, text: str, start: float) -> Verdict:
    return Verdict(
        verdict=decision.verdict,
        conditions=decision.conditions,
        requires=tuple(requirement.text for requirement in decision.requires),
        counterexample=decision.counterexample,
        reason=decision.reason,
        notes=decision.notes,
        text=text,
        seconds=perf_counter() - start,
    )
