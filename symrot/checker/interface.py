"""The functions ``check`` and ``check_file``, which return verdicts on claims."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import Any

from symrot.checker.approximation import verdict_on_approximation
from symrot.checker.claim.reader import check_length
from symrot.checker.claim.size import MOST_NESTED, nesting
from symrot.checker.claim.source.file import Refusal, read_entries
from symrot.checker.claim.source.text import functions_of_time, is_latex
from symrot.checker.claim_verdict import check_claim, check_readings, verdict_of_decision, within_budget
from symrot.checker.context.context import Context
from symrot.checker.context.statements import read_context
from symrot.checker.decide.decision import decide_equation
from symrot.checker.decide.equation import Equation
from symrot.checker.equivalents.inertia_in_frames import without_brackets
from symrot.checker.equivalents.rotations_by_angle import with_axis
from symrot.checker.frame_rates import verdict_on_rates, without_marks
from symrot.checker.text.readings import verdict_on_readings, verdict_on_text
from symrot.checker.typed.copied_signs import with_plain_signs
from symrot.checker.units.check import dimensions_of_formulas
from symrot.checker.units.conversion import measured_text, numbers_of_latex
from symrot.checker.verdict import Verdict
from symrot.errors import InputError
from symrot.exact.decision import flatten
from symrot.exact.printing import as_text

__all__ = ["RefusedClaims", "check", "check_claim", "check_file", "check_readings", "verdicts_of_file"]


class RefusedClaims(InputError):
    """Error raised if some claims of a file are refused: they cannot be read, or have no meaning.

    Attributes
    ----------
    verdicts : list of Verdict
        The verdicts on all claims of the file, in its order; ``"refused"`` for a claim that cannot be read or has no
        meaning, such as a division by zero.

    Examples
    --------
    >>> import symrot
    >>> issubclass(symrot.RefusedClaims, symrot.InputError)
    True
    """

    def __init__(self, verdicts: Sequence[Verdict]) -> None:
        self.verdicts = list(verdicts)
        first, *others = (verdict.reason for verdict in verdicts if verdict.verdict == "refused")
        super().__init__(first + (f" (and {len(others)} more claims of the file are refused)" if others else ""))


def check(
    left: Any,
    right: Any = None,
    *,
    assume: Sequence[Any] = (),
    units: Mapping[str, str] | None = None,
    repair: bool = True,
    where: Sequence[str] = (),
    body: str = "",
    frame: str = "",
    sequence: str = "",
) -> Verdict:
    """Return the verdict on an equation.

    Parameters
    ----------
    left : str, Expr or Matrix
        The whole claim as text, ``"left == right"`` in SymPy syntax, as people type it, or in LaTeX (with a backslash,
        a brace or a dollar sign): names are real symbols, ``phi(t)`` is a function of time. Or the left side as a SymPy
        expression or matrix, or the whole claim as a SymPy ``Eq``.
    right : Expr or Matrix, optional
        The right side, if ``left`` is a SymPy expression or matrix.
    assume : sequence
        Hypotheses. If the claim is a string: strings ``"a == b"``, ``"x > 0"``, ``"x != 0"``. If it is a SymPy value:
        equations ``Eq(a, b)``, or expressions; ``a - b`` means that a - b is zero.
    units : mapping of str to str, optional
        Units by the name of a symbol, ``{"x": "m"}``. Names such as ``I1``, ``omega_1`` and ``g``, and the symbols of
        symrot, have their usual units; the claim may imply others. An equation that is no identity may
        be ``"false"`` instead of ``"definition"`` if its units do not fit.
    repair : bool
        Whether to diagnose a claim that is not true and to look for true formulas near it.
    where : sequence of str
        The meanings of names, in words: ``"I = moment of inertia about the centre"``. Without such words, or those of
        ``body``, a claim such as ``"I = m r^2/2"`` is at best "recognised" as a known formula; with them it is "true".
    body : str
        The body in words, ``"solid cylinder of radius r"``.
    frame : str
        ``"body"`` or ``"space"``: the frame of angular velocities and of rates.
    sequence : str
        The sequence of Euler angles, ``"ZXZ"``, ``"3-1-3"`` or ``"zyx"``.

    Returns
    -------
    Verdict
        ``.verdict`` is ``"true"``, ``"false"``, ``"conditional"`` (true if a condition in ``.requires`` holds) or
        ``"undecided"``. A claim that gives a formula for a quantity without defining it, such as ``"I = m r^2/2"``, may
        be ``"recognised"`` (symrot knows the formula), ``"doubtful"`` (one edit makes it a formula that symrot knows)
        or a ``"definition"`` (symrot does not judge it). A text that holds for some values only, such as ``"x^2 = 4"``
        or ``"omega > 2"``, is a ``"definition"`` too. ``.dimension`` says whether the units fit.

    Raises
    ------
    InputError
        For text that cannot be read (with its position), unknown functions, shapes that do not fit, and divisors that
        are zero everywhere. Text is never evaluated as Python.

    Notes
    -----
    Source: ``docs/exact_decisions.md`` says how claims are decided and why the decision is sound.

    Examples
    --------
    >>> check("cos(2*x) == 1 - 2*sin(x)**2").verdict
    'true'
    >>> check("I_zz == m*R**2/2", body="solid cylinder").verdict
    'true'
    """
    stated = read_context(where, body, frame, sequence)
    if units is not None and not isinstance(units, Mapping):
        raise InputError(f"units: expected a mapping like {{'x': 'm'}} from names to units, got {units!r}")
    if stated and not isinstance(left, str):
        raise InputError(
            "where, body, frame, sequence: expected these options only with a claim that is a string, got a SymPy value"
        )
    try:
        return _checked(left, right, assume, units, repair, stated)
    except RecursionError:
        raise InputError("expected formulas that are nested less deeply") from None


def _checked(
    left: Any, right: Any, assume: Sequence[Any], units: Mapping[str, str] | None, repair: bool, stated: Context
) -> Verdict:
    if isinstance(left, str):
        if right is not None:
            raise InputError("expected the whole claim 'left == right' as one string, got two arguments")
        if isinstance(assume, str) or not isinstance(assume, Collection) or not all(isinstance(a, str) for a in assume):
            raise InputError(
                f"assume: expected a list of strings like 'a == b', since the claim is a string, got {assume!r}"
            )
        typed = _without_backticks(left).lstrip()  # places in the text count from its first character
        check_length(typed)  # before any search in the text, whose time grows with its length
        if not assume and not stated and (of_frames := verdict_on_rates(typed)) is not None:
            return of_frames
        if not assume and not stated and (approximate := verdict_on_approximation(typed)) is not None:
            return approximate
        typed, of_mark = without_marks(typed)
        with_axes, of_axis = with_axis(typed)
        left = with_plain_signs(without_brackets(with_axes))
        if is_latex(left) and measured_text(left) is None:
            left = numbers_of_latex(left).lstrip() or left
        if is_latex(left) and measured_text(left) is None:
            verdict = _on_latex(left, assume, units, repair, stated)
        else:
            verdict = verdict_on_text(left, assume, units, repair, stated)
        if of_mark or of_axis:
            verdict = replace(verdict, notes=(*filter(None, (of_mark, of_axis)), *verdict.notes))
        if left == typed:
            return verdict
        return replace(verdict, text=typed.strip(), notes=(f"it is read as {left.strip()}", *verdict.notes))
    if right is None and getattr(left, "rel_op", "") == "==":
        left, right = left.args
    if right is None:
        raise InputError("expected two sides, or one string 'left == right'")
    if isinstance(assume, str) or not isinstance(assume, Iterable):
        raise InputError(f"assume: expected a list of hypotheses, such as [Eq(a, b)], got {assume!r}")
    for side in (left, right):
        for entry in flatten(side)[0]:
            if nesting(entry) > MOST_NESTED:
                raise InputError(f"expected at most {MOST_NESTED} functions and roots inside each other")
    start, text = perf_counter(), f"{as_text(left)} == {as_text(right)}"
    equation = Equation(left, right, tuple(assume))
    verdict = within_budget(lambda: verdict_of_decision(decide_equation(equation), text, start), text)
    return replace(verdict, dimension=dimensions_of_formulas(left, right, units))


def _without_backticks(source: str) -> str:
    """Return a text without the backticks around it; web posts put them around formulas."""
    bare = source.strip()
    return bare.strip("`") if len(bare) > 1 and bare[0] == bare[-1] == "`" else source


def _on_latex(
    source: str, assume: Sequence[str], units: Mapping[str, str] | None, repair: bool, stated: Context
) -> Verdict:
    """Return the verdict on a text in LaTeX, with the claim and its repairs in LaTeX too."""
    from symrot.checker.latex.reader import Names, latex_readings
    from symrot.checker.latex.shorthand import without_definitions
    from symrot.checker.latex.writing import LatexNotation

    # the arguments are those of verdict_on_text
    assume = without_definitions(assume, source)
    functions = functions_of_time(assume)
    readings = latex_readings(source, Names(functions=functions))
    return verdict_on_readings(
        readings, lambda reading: LatexNotation(functions, reading.vectors), source, assume, units, repair, stated
    )


def check_file(path: str | Path, *, repair: bool = True) -> list[Verdict]:
    """Return the verdicts on the claims of a TOML file, in its order.

    Parameters
    ----------
    path : str or Path
        A TOML file of claims, as ``docs/checkers.md`` describes it.
    repair : bool
        Whether to diagnose claims that are not true, and to search for true formulas near them.

    Returns
    -------
    list of Verdict
        One for each claim, in the order of the file.

    Raises
    ------
    InputError
        For a file that is not a file of claims.
    RefusedClaims
        If some claims are refused, after all others were decided. The message names the file and the first such claim;
        ``.verdicts`` are the verdicts on all claims.

    Examples
    --------
    >>> import symrot, tempfile
    >>> from pathlib import Path
    >>> lines = ["schema = 1", "[[claim]]", 'id = "a"', 'symbols = ["x"]', 'claim = "sin(2*x) == 2*sin(x)*cos(x)"']
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder, "claims.toml")
    ...     _ = path.write_text(chr(10).join(lines))
    ...     [verdict.verdict for verdict in symrot.check_file(path)]
    ['true']
    """
    verdicts = list(verdicts_of_file(path, repair))
    if any(verdict.verdict == "refused" for verdict in verdicts):
        raise RefusedClaims(verdicts)
    return verdicts


def verdicts_of_file(
    path: str | Path, repair: bool = True, progress: Callable[[str], None] = lambda text: None
) -> Iterator[Verdict]:
    """Yield the verdict on each claim of a file; a claim that cannot be read or has no meaning is ``"refused"``, with a
    reason.

    ``progress`` is called with a line of text before the check of each claim that can be read.
    """
    for entry in read_entries(path):
        if isinstance(entry, Refusal):
            yield Verdict("refused", reason=entry.reason, id=entry.id, where=entry.where, text=entry.text)
            continue
        progress(f"checking {entry.id} ..")
        try:
            yield replace(check_claim(entry, repair), context=entry.context.echo)
        except InputError as reason:
            sentence = str(reason) if str(path) in str(reason) else f"{path}: {reason}"
            yield Verdict("refused", reason=sentence, id=entry.id, where=entry.where, text=entry.text)
