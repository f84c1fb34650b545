"""Grading of formulas: the checker decides whether a formula equals the right answer, and otherwise names the error."""

import re
from collections.abc import Collection, Iterator
from dataclasses import replace

from symrot.checker.interface import check
from symrot.checker.verdict import Verdict
from symrot.errors import InputError
from symrot.exercises.exercise import Question
from symrot.exercises.grading.left_side import names_only
from symrot.exercises.grading.mark import Mark
from symrot.exercises.grading.words import FORMULA_FAULTS, RIGHT

__all__ = ["mark_formula"]

_SUBSCRIPTS = str.maketrans(
    {**{chr(0x2080 + n): f"_{n}" for n in range(10)}, "−": "-", "²": "^2", "³": "^3", "·": "*", "⋅": "*", "×": "*",
     "π": " pi ", "√": " sqrt "}
)  # fmt: skip
GREEK = {
    "α": "alpha", "θ": "theta", "φ": "phi", "ϕ": "phi", "ψ": "psi", "ω": "omega", "Ω": "Omega", "τ": "tau",
    "δ": "delta", "γ": "gamma", "μ": "mu", "ρ": "rho", "β": "beta", "ε": "epsilon",
}  # fmt: skip
"""Greek letter -> its name in claims."""

FUNCTIONS = (
    "sin", "cos", "tan", "cot", "sec", "csc", "sqrt", "pi", "asin", "acos", "atan", "atan2", "abs", "exp", "log",
)  # fmt: skip
"""The names, besides those of the given quantities, that a formula may contain: functions and pi."""

LONGEST_PRODUCT = 12
"""Largest number of letters in a product that is written without signs, such as ``mgl``."""

JOIN = "\N{INVISIBLE TIMES}"
"""Sign between names that were written together, as in ``Cω``."""

MAYBE_EXCHANGED = ("none", "two_faults", "dimension")
"""Diagnoses of a formula that may be right with two letters exchanged."""

_NAME = re.compile(r"[^\W\d]\w*")
_CHAIN = re.compile(rf"/\s*([^\W\d]\w*(?:{JOIN}[^\W\d]\w*)+)((?:\^|\*\*)\s*\d+)?")
_JOINED = re.compile(r"(?P<divided>/\s*)?(?P<name>[^\W\d]\w*)(?P<power>(?:\^|\*\*)\s*\d+)?")


def mark_formula(key: str, answer: str, question: Question) -> Mark:
    """Grade an answer that is a formula, and return its mark.

    Parameters
    ----------
    key : str
        The name of the question, which the mark repeats.
    answer : str
        The formula as typed text or LaTeX, with or without its name and ``=`` in front.
    question : Question
        Of kind ``"formula"``.
    """
    try:
        left, formula = _parts(answer, question)
        if left and not names_only(left, question.name, question.symbols):
            _require_right(left, question)
        own, truth = _sides(formula, question)
        verdict = _verdict(own, truth, question)
    except InputError as reason:
        return Mark(key, answer, "unread", text=str(reason))
    if _is_right(verdict):
        return Mark(key, answer, "right", RIGHT)
    if verdict.verdict not in ("false", "conditional"):
        return Mark(
            key, answer, "undecided", text=f"symrot could not decide this answer: {verdict.reason or verdict.verdict}"
        )
    code = _code(own, truth, verdict, question)
    credit, sentence = FORMULA_FAULTS.get(code, FORMULA_FAULTS["none"])
    misfit = _misfit(own, truth, question)
    return Mark(key, answer, "wrong", credit, code, f"{sentence} ({misfit})" if misfit else sentence)


def _misfit(own: str, truth: str, question: Question) -> str:
    """Return a sentence that says how the units of an answer differ from the right units.

    It is empty if the units agree or cannot be compared.
    """
    try:
        dimension = _verdict(own, truth, question, repair=False, units=question.symbols).dimension
    except InputError:  # LaTeX in which the names of the units do not occur
        return ""
    if dimension.status != "inconsistent":
        return ""
    return dimension.text.replace("the left side", "the answer").replace("the right side", "your formula")


def _is_right(verdict: Verdict) -> bool:
    return verdict.verdict == "true" or (verdict.verdict == "conditional" and not verdict.requires)


def _verdict(
    own: str, truth: str, question: Question, repair: bool = True, units: dict[str, str] | None = None
) -> Verdict:
    """Return the checker's verdict on the claim that a student's formula ``own`` equals the right formula ``truth``."""
    latex = "\\" in own
    assume = [f"{name} > 0" for name in question.positive if not latex]
    # Without units, the checker also finds other errors in a formula whose units are wrong. With repair it looks for a
    # change that makes the formula right.
    return check(f"{truth} = {own}" if latex else f"{truth} == {own}", assume=assume, units=units, repair=repair)


def _parts(answer: str, question: Question) -> tuple[str, str]:
    """Return the text in front of the equals sign of an answer, empty if there is none, and the formula behind it.

    Raise InputError for a text with several equations or without a formula.
    """
    text = answer.strip().strip("$").strip()
    *names, formula = re.split(r"==?|:=", text)
    if len(names) > 1 or not formula.strip() or "\n" in formula:
        raise InputError(f"expected one formula for ${question.name}$ with at most one '=', got {answer[:60]!r}")
    return "".join(names).strip(), formula


def _require_right(left: str, question: Question) -> None:
    """Raise InputError unless the formula on the left side of a student's equation equals the correct answer.

    It is called for a left side that is more than a name of the asked quantity, as in ``2 m L^2/6 = m L^2/3``.
    """
    try:
        is_right = _is_right(_verdict(*_sides(left, question), question, repair=False))
    except InputError:
        is_right = False
    if not is_right:
        raise InputError(
            f"expected a formula for ${question.name}$, alone or after its name and '=', got {left[:60]!r} in front of "
            "'='"
        )


def _sides(formula: str, question: Question) -> tuple[str, str]:
    """Return the student's formula and the right formula, both as LaTeX or both as typed text.

    Raise InputError for typed names that the exercise does not have.
    """
    if "\\" in formula:
        return formula, question.latex
    bare = re.sub(r"\{([^{}]*)\}", r"(\1)", re.sub(r"(?<=_)\{([^{}]*)\}", r"\1", formula))
    known = (*question.symbols, *FUNCTIONS)
    plain = _CHAIN.sub(_chain, _plain(bare.translate(_SUBSCRIPTS))).replace(JOIN, " ")
    plain = _JOINED.sub(lambda match: _split(match, known), plain)
    unknown = sorted({name for name in _NAME.findall(plain) if name not in known})
    if unknown:
        letters = ", ".join(name for name in question.symbols if name in _NAME.findall(question.answer))
        raise InputError(f"expected a formula in {letters}, got a formula that contains {', '.join(unknown)}")
    # in brackets, the checker reads no factor at the end, as in 2 (1.5), as the number of an equation or a remark
    return f"1*({plain})" if re.fullmatch(r"\s*\w+\s*", plain) else f"({plain})", question.answer


def _plain(text: str) -> str:
    """Return a typed formula in the checker's language.

    Greek letters are spelled out, with JOIN between names that were written together. Rates are written as ``dphi``
    (for ``phi_dot`` or a letter with a dot), and inverse functions as ``acos`` (for ``arccos``).
    """
    text = re.sub(r"\barc(sin|cos|tan)", r"a\1", text)
    text = re.sub(r"\bAbs\b", "abs", text)
    for letter, name in GREEK.items():
        text = text.replace(f"{letter}\u0307", f" d{name}")
        text = re.sub(rf"\b{name}_?dot\b", f"d{name}", text)
        text = re.sub(rf"(?<=[^\W_]){letter}", f"{JOIN}{letter}", text).replace(letter, name)
        text = re.sub(rf"{name}(?=[^\W\d_])", f"{name}{JOIN}", text)
    return text


def _chain(match: re.Match[str]) -> str:
    """Return the divisor ``/(C*omega)`` for ``/Cω``: names that are written together after ``/`` all divide.

    ``match`` is a match of ``_CHAIN``. If one of the names is a function, as in ``/cosθ``, the text is not changed.
    """
    names = match[1].split(JOIN)
    return match[0] if any(name in FUNCTIONS for name in names) else f"/({'*'.join(names)}{match[2] or ''})"


def _split(match: re.Match[str], known: Collection[str]) -> str:
    """Return a name as known names: ``m1`` gives ``m_1``, ``mgl`` gives ``m*g*l``, ``/mgl^2`` gives ``/(m*g*l^2)``."""
    name, power, divided = match["name"], match["power"] or "", match["divided"] or ""
    spelled = re.sub(r"(?<=[A-Za-z])(\d)", r"_\1", name)
    for single in (name, spelled, name.replace("_", "")):
        if single in known:
            return f"{divided}{single}{power}"
    product = "*".join(next(_partitions(name, known), (name,))) + power
    return f"{divided}({product})" if divided else product


def _partitions(name: str, known: Collection[str]) -> Iterator[tuple[str, ...]]:
    """Yield the ways to write a name of at most LONGEST_PRODUCT letters as a product of known symbols.

    ``mgl`` gives ``("m", "g", "l")``.
    """
    if not name:
        yield ()
    if len(name) > LONGEST_PRODUCT:
        return
    for part in sorted(known, key=len, reverse=True):
        if part not in FUNCTIONS and name.startswith(part):
            yield from ((part, *rest) for rest in _partitions(name[len(part) :], known))


def _code(own: str, truth: str, verdict: Verdict, question: Question) -> str:
    """Return the code of the student's error, such as ``"inverse"`` for 1/x instead of x.

    Most codes are keys of :data:`symrot.exercises.grading.words.FORMULA_FAULTS`.
    """
    if "\\" not in own:
        if _holds(f"1/({own})", truth, question):
            return "inverse"
        if verdict.diagnosis.code in MAYBE_EXCHANGED and _exchanged(own, truth, question):
            return "exchanged"
    code = verdict.diagnosis.code
    if "\\" not in own and not _letters(own, question):
        return "none"
    if "\\" not in own and code == "factor" and not _letters(truth, question) <= _letters(own, question):
        return "letter_missing"
    if verdict.requires:
        return "requires_condition"
    if code == "dimension" and "\\" not in own:
        code = _code_without_units(own, truth, question)
    if code == "dimension" or (code == "none" and _misfit(own, truth, question)):
        return "unit"
    return code


def _letters(formula: str, question: Question) -> set[str]:
    """Return the names of those symbols of the exercise ``question`` that occur in ``formula``."""
    return {name for name in _NAME.findall(formula) if name in question.symbols}


def _code_without_units(own: str, truth: str, question: Question) -> str:
    """Return the checker's code for the error, other than wrong units, in the formula ``own``; ``truth`` is right."""
    # The checker stops at wrong units, so the symbols get names without a conventional unit.
    letters = {name: f"x_{place}" for place, name in enumerate(question.symbols, 1)}
    plain = {letters[name]: "1" for name in question.symbols}
    renamed = replace(question, symbols=plain, positive=tuple(letters[name] for name in question.positive))
    first, second = (_NAME.sub(lambda match: letters.get(match[0], match[0]), side) for side in (own, truth))
    return _verdict(first, second, renamed).diagnosis.code


def _holds(own: str, truth: str, question: Question) -> bool:
    """Return whether ``own``, such as the reciprocal of the student's formula, equals the right formula."""
    try:
        return _is_right(_verdict(own, truth, question, repair=False))
    except InputError:
        # no value, such as 1/0
        return False


def _exchanged(own: str, truth: str, question: Question) -> bool:
    """Return whether the formula ``own`` becomes the right formula ``truth`` if two of its symbols are exchanged."""
    names = sorted({name for name in _NAME.findall(own) + _NAME.findall(truth) if name in question.symbols})
    for place, first in enumerate(names):
        for second in names[place + 1 :]:
            pair = {first: second, second: first}
            exchanged = _NAME.sub(lambda match: pair.get(match[0], match[0]), own)  # noqa: B023
            if exchanged != own and _holds(exchanged, truth, question):
                return True
    return False
