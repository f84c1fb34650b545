"""``check`` and ``check_file``: a claim in, a verdict out."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import Any

from symrot.checker.claims import Claim, claim_of_text, read_claims
from symrot.checker.decision import Problem, decide_problem, shown
from symrot.checker.values import decide_value
from symrot.checker.verdict import Verdict
from symrot.errors import InputError

__all__ = ["check", "check_claim", "check_file"]


def check(left: Any, right: Any = None, *, assume: Sequence[Any] = (), repair: bool = True) -> Verdict:
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
    repair : bool
        Whether to look for what went wrong with a claim that is not true, and for true formulas near it.

    Returns
    -------
    Verdict
        ``.verdict`` is ``"true"``, ``"false"``, ``"conditional"`` or ``"undecided"``.

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
        return check_claim(claim_of_text(left, assume), repair)
    if right is None:
        raise InputError("expected two sides, or one text 'left == right'")
    start = perf_counter()
    decision = decide_problem(Problem(left, right, tuple(assume)))
    return _verdict(decision, f"{shown(left)} == {shown(right)}", start)


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
    if repair and claim.relation is not None and decision.verdict in ("false", "conditional"):
        from symrot.checker.diagnose import diagnose

        diagnosis, repairs = diagnose(claim, decision)
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
