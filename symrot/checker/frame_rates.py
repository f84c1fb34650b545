r"""Equations with the rates of one vector seen from two frames, ``(dA/dt)_I = (dA/dt)_B + ω × A`` (transport theorem).

The mark I or B names the frame from which a rate is seen, so the equation can be decided: the vector A gets arbitrary
components in a frame B that rotates arbitrarily. The rate of A seen from B is the derivative of these components; the
rate of A seen from I is the derivative of its components in I.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any

from sympy import Function, Matrix, Symbol

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.interpreter import time
from symrot.checker.claim.reader import readings_of
from symrot.checker.claim.source.lines import claims_of_reading
from symrot.checker.claim.source.text import is_latex
from symrot.checker.claim_verdict import verdict_of_decision, within_budget
from symrot.checker.decide.decision import decide_equation
from symrot.checker.decide.equation import Equation
from symrot.checker.latex.reader import latex_readings
from symrot.checker.verdict import Verdict
from symrot.errors import InputError
from symrot.kinematics.rotations import elementary_rotation, vee

__all__ = ["verdict_on_rates", "without_marks"]

INERTIAL = {"", "I", "N", "s", "S", "i", "O", "E", "in", "fixed", "space", "inertial", "lab", "abs"}
"""Names of a frame that does not rotate, as written at a derivative: s in ``(dA/dt)_s``; "" if none is written."""

ROTATING = {"B", "b", "body", "rot", "rotating", "r"}
"""Names of a rotating frame, as written at a derivative: B in ``(dA/dt)_B``."""

MARKED = "moving"
"""Name that symrot gives to the frame of ``d'A/dt``, and of A with a ring above. These derivatives are derivatives in a
rotating frame, but do not name the frame."""

TEXT = r"\{?\\(?:mathrm|text|textrm|mathcal|textit|rm)\s*\{?\s*(?P<{0}t>\w+'?)\s*\}*"
LABEL = r"(?:_\s*(?:\{\s*(?P<{0}b>\w+'?)\s*\}|" + TEXT + r"|(?P<{0}w>\w)(?!\w)))"
ABOVE = r"(?:\{\}\s*|(?<![\w}]))\^\s*(?:\{\s*(?P<{0}b>\w+'?)\s*\}|" + TEXT + r"|(?P<{0}w>\w))\s*"
VECTOR = r"(?P<v>\\(?:mathbf|vec|boldsymbol|bm|vb|bf|mathsf)\s*(?:\{\s*\\?\w+\s*\}|\\?[A-Za-z]+)|\\?[A-Za-z])"
D = r"(?:d|\\mathrm\s*\{?\s*d\}?|\\dd)\s*"
DT = r"\{\s*" + D + r"\s*t\s*\}"
SIZE = r"(?:\\left|\\right|\\big|\\Big|\\bigg|\\Bigg)?\s*"
OPEN, CLOSE = SIZE + r"(?:\(|\[|\.)\s*", r"\s*" + SIZE + r"(?:\)|\]|\\?\|)\s*"
OTHER_D = r"(?:d\s*'|d\s*\^\s*\{?\s*(?:\*|\\prime|\\star|\\ast)\s*\}?|\\tilde\s*\{?\s*d\s*\}?|\\delta)\s*"
OTHER_DT = r"\{\s*(?:" + D + r"|\\delta\s*)t\s*\}"

LATEX = tuple(re.compile(pattern) for pattern in (
    OPEN + r"\\d?frac\s*\{\s*" + D + VECTOR + r"\s*\}\s*" + DT + CLOSE + LABEL.replace("{0}", "l"),
    OPEN + r"\\d?frac\s*\{?\s*" + D + r"\}?\s*" + DT + CLOSE + LABEL.replace("{0}", "l") + r"\s*" + VECTOR,
    r"\\d?frac\s*\{\s*" + ABOVE.replace("{0}", "l") + D + VECTOR + r"\s*\}\s*" + DT,
    r"\\d?frac\s*\{\s*" + ABOVE.replace("{0}", "l") + D + r"\}\s*" + DT + r"\s*" + VECTOR,
    ABOVE.replace("{0}", "l") + r"\\d?frac\s*\{\s*" + D + r"\}\s*" + DT + r"\s*" + VECTOR,
    ABOVE.replace("{0}", "l") + r"\\d?frac\s*\{\s*" + D + VECTOR + r"\s*\}\s*" + DT,
    r"(?P<ring>)\\d?frac\s*\{\s*" + OTHER_D + VECTOR + r"\s*\}\s*" + OTHER_DT,
    r"(?P<ring>)\\d?frac\s*\{\s*" + OTHER_D + r"\}\s*" + OTHER_DT + r"\s*" + VECTOR,
    r"(?P<ring>)\\(?:mathring|overset\s*\{?\s*\\circ\s*\}?)\s*\{\s*" + VECTOR + r"\s*\}",
    r"\\d?frac\s*\{\s*" + D + VECTOR + r"\s*\}\s*" + DT,
    r"\\d?frac\s*\{\s*" + D + r"\}\s*" + DT + r"\s*" + VECTOR,
    r"\\dot\s*\{\s*" + VECTOR + r"\s*\}",
))  # fmt: skip
"""Patterns of the time derivative of a vector in LaTeX: first the patterns with a mark for the frame, then those
without."""

PLAIN = tuple(re.compile(pattern) for pattern in (
    r"\(\s*d(?P<v>\w)\s*/\s*dt\s*\)\s*_\s*\{?(?P<lb>\w+'?)\}?",
    r"(?P<ring>)(?:d\s*'|d\*|δ)\s*(?P<v>\w)\s*/\s*[dδ]t",
    "(?P<ring>)(?P<v>\\w)\N{COMBINING RING ABOVE}",
    r"(?<![\w(])d(?P<v>\w)\s*/\s*dt(?!\w)",
    "(?P<v>\\w)\N{COMBINING DOT ABOVE}",
))  # fmt: skip
"""Patterns of the time derivative of a vector in plain text: first the patterns with a mark for the frame, such as
``(dA/dt)_B``, then those without, such as ``dA/dt``."""

OMEGA = r"(?P<omega>\\(?:boldsymbol|mathbf|vec|bm)\s*(?:\{\s*\\\w+\s*\}|\\\w+)|\\[oO]mega|[ωΩ])\s*"
MARK = r"\{?\s*(?:\\(?:mathcal|mathrm|text)\s*\{?)?\s*(?P<{0}>\w+'?)\s*\}*"
DIRECTIONS = (
    re.compile(
        r"\{\}\s*\^\s*" + MARK.replace("{0}", "still") + r"\s*" + OMEGA + r"\^\s*" + MARK.replace("{0}", "moving")
    ),
    re.compile(OMEGA + r"_\s*\{\s*(?P<moving>\w+'?)\s*/\s*(?P<still>\w+'?)\s*\}"),
    re.compile(OMEGA + r"_(?P<moving>\w)/(?P<still>\w)"),
)
"""Patterns of an angular velocity that names two frames, ``{}^N ω^B`` and ``ω_{B/N}``.

It is the angular velocity of the frame in the group ``moving``, B, relative to the frame in the group ``still``, N.
"""

OPERATOR = re.compile(OPEN + r"\\d?frac\s*\{?\s*" + D + r"\}?\s*" + DT + CLOSE + LABEL.replace("{0}", "l"))

NAMES = "uwshn"
"""Letters that may replace the rates of a vector in two frames; the first two that the text does not use are taken."""


@dataclass(frozen=True)
class _Rate:
    """A time derivative of a vector in a text: its start and end in the text, the vector, and the frame."""

    start: int
    end: int
    vector: str
    frame: str  # B for (dA/dt)_B, "" if no frame is written, MARKED for a ring above the vector


def verdict_on_rates(source: str) -> Verdict | None:
    """Return the verdict on an equation with the rates of one vector seen from two frames.

    Return None for other texts, and for equations that cannot be read.
    """
    typed, source = source, _with_operand(source)
    rates = list(_rates_in(source))
    frames = list(dict.fromkeys(rate.frame for rate in rates))
    vectors = {"".join(rate.vector.split()) for rate in rates}
    if len(frames) != 2 or len(vectors) != 1:
        return None
    start, text = perf_counter(), typed.strip()
    still, moving = sorted(frames, key=lambda frame: frame not in INERTIAL)
    letters = [letter for letter in NAMES if not re.search(rf"(?<![A-Za-z\\]){letter}(?![A-Za-z])", source)]
    if len(letters) < 2:
        return None
    names = dict(zip((still, moving), letters, strict=False))
    source, rates, direction = _without_direction(source, still, moving)
    try:
        claim = _claim(_replaced(source, rates, names))
        sides = [_column(side) for side in (claim.equation.left, claim.equation.right)]
    except InputError:
        return None
    others = [name for name, _ in claim.define if name not in letters[:2]]
    own = [name for name in others if name in _plain(next(iter(vectors)))]
    if len(own) != 1 or len(others) != 2 or None in sides:
        return None
    (angular,) = (name for name in others if name != own[0])
    equations = [
        Equation(*(side.xreplace(values) for side in sides))
        for values in (_values(names, still, moving, own[0], angular, sign) for sign in (1, -1))
    ]
    first, second = (
        within_budget(lambda: verdict_of_decision(decide_equation(equation), text, start), text)  # noqa: B023 called at once
        for equation in equations
    )
    words = {still: _frame(still), moving: _frame(moving)}
    notes: tuple[str, ...] = (f"the rates are those of {own[0]} seen from {words[still]} and from {words[moving]}",)
    if direction < 0:
        notes += (f"{angular} is the angular velocity of {words[still]} relative to {words[moving]}",)
        return replace(second, notes=notes)
    if first.verdict == "true" or direction or second.verdict != "true":
        notes += (f"{angular} is the angular velocity of {words[moving]} relative to {words[still]}",)
        return replace(first, notes=notes)
    condition = f"{angular} is the angular velocity of {words[still]} relative to {words[moving]}"
    usual = f"usually {angular} is the angular velocity of {words[moving]}, and the cross product has the other sign"
    return replace(second, verdict="conditional", requires=(condition,), conditions=(condition,), notes=(*notes, usual))


def _with_operand(source: str) -> str:
    """Return an equation in which the sign × replaces a letter x that stands for it, as in ``ω x A``.

    Such an x has blanks around it, ω, Ω or w before it, and a single letter after it. An equation between operators in
    LaTeX, ``(d/dt)_I = (d/dt)_B + ω ×``, gets a vector A after each ``(d/dt)`` and after the × at its end.
    """
    source = re.sub(r"(?<=[wωΩ]) x (?=\w\b)", " × ", source)
    if not re.search(r"\\times\s*$", source):
        return source
    return OPERATOR.sub(lambda match: match[0] + r" \mathbf{A}", source) + r" \mathbf{A}"


def _without_direction(source: str, still: str, moving: str) -> tuple[str, list[_Rate], int]:
    """Return (text, rates, direction), where the text has ω in place of one ``{}^N ω^B`` or ``ω_{B/N}``.

    ``rates`` are the time derivatives in this text. The direction is 1 if the indices of ω state the angular velocity
    of the frame ``moving`` relative to the frame ``still``, and -1 if they state the reverse. If no ω has these two
    indices, the text is unchanged and the direction is 0.
    """
    for pattern in DIRECTIONS:
        for match in pattern.finditer(source):
            frames = match["moving"], match["still"]
            if {*frames} == {still, moving}:
                source = source[: match.start()] + match["omega"] + " " + source[match.end() :]
                return source, list(_rates_in(source)), 1 if frames == (moving, still) else -1
    return source, list(_rates_in(source)), 0


def without_marks(source: str) -> tuple[str, str]:
    """Return (text, note): a text with ``dA/dt`` in place of ``(dA/dt)_s``, and a note for the user on the frame s.

    A mark such as s is left out if it is a usual name of a frame (in INERTIAL or ROTATING) and the text has no other
    mark of this kind. Otherwise return the text unchanged and the note "".
    """
    marked = [rate for rate in _rates_in(source) if rate.frame in {*INERTIAL, *ROTATING} - {""}]
    if not marked or len({rate.frame for rate in marked}) != 1:
        return source, ""
    whole = source
    for rate in reversed(marked):
        plain = rf"\frac{{d{rate.vector}}}{{dt}}" if is_latex(source) else f"d{rate.vector}/dt"
        whole = f"{whole[: rate.start]}{plain} {whole[rate.end :]}"
    return whole, f"the label {marked[0].frame} for the frame of a derivative is ignored"


def _rates_in(source: str) -> Iterator[_Rate]:
    """Yield the time derivatives of vectors in a text, in the order of the text."""
    covered: list[tuple[int, int]] = []
    rates = []
    for pattern in LATEX if is_latex(source) else PLAIN:
        for match in pattern.finditer(source):
            if any(match.start() < end and start < match.end() for start, end in covered):
                continue
            covered.append(match.span())
            groups = match.groupdict()
            label = next((groups[key] for key in ("lb", "lt", "lw") if groups.get(key)), "")
            frame = MARKED if "ring" in groups else label
            rates.append(_Rate(*match.span(), match["v"], frame))
    yield from sorted(rates, key=lambda rate: rate.start)


def _replaced(source: str, rates: Sequence[_Rate], names: Mapping[str, str]) -> str:
    for rate in reversed(rates):
        name = rf"\mathbf{{{names[rate.frame]}}}" if is_latex(source) else names[rate.frame]
        source = f"{source[: rate.start]} {name} {source[rate.end :]}"
    return source


def _claim(source: str) -> Claim:
    reading = (latex_readings if is_latex(source) else readings_of)(source)[0]
    ((claim,),) = claims_of_reading(reading, source)
    return claim


def _column(side: Any) -> Any:
    """Return a side of an equation that is a column of three components; for a name v, the column (v_x, v_y, v_z).

    Return None for any other side, such as a number.
    """
    if isinstance(side, Symbol):
        return Matrix([Symbol(f"{side}_{axis}", real=True) for axis in "xyz"])
    return side if getattr(side, "shape", None) == (3, 1) else None


def _plain(vector: str) -> str:
    """Return the letters of a vector's name in LaTeX: "A" for ``\\mathbf{A}``, "omega" for ``\\vec\\omega``."""
    return re.sub(r"\\(?:mathbf|vec|boldsymbol|bm|vb|bf|mathsf)(?![A-Za-z])|[{}\\\s]", "", vector)


def _values(
    names: Mapping[str, str], still: str, moving: str, vector: str, angular: str, sign: int
) -> dict[Symbol, Any]:
    """Return {symbol: formula} for the components of four vectors along the axes of the moving frame, such as ``v_x``.

    The four vectors are ``vector``, its rate seen from the frame ``still``, its rate seen from the frame ``moving``,
    and ``angular``: ``sign``, 1 or -1, times the angular velocity of the moving frame. The moving frame rotates
    arbitrarily, and ``vector`` has arbitrary components. ``names`` maps each frame to the name of the rate seen from
    it.
    """
    angles = [Function(f"angle_{number}", real=True)(time) for number in range(3)]
    turned = (
        elementary_rotation("z", angles[0]) * elementary_rotation("x", angles[1]) * elementary_rotation("z", angles[2])
    )
    components = Matrix([Function(f"component_{number}", real=True)(time) for number in range(3)])
    columns = {
        vector: components,
        names[moving]: components.diff(time),
        names[still]: turned.T * (turned * components).diff(time),
        angular: sign * vee(turned.T * turned.diff(time)),
    }
    return {
        Symbol(f"{name}_{axis}", real=True): column[place]
        for name, column in columns.items()
        for place, axis in enumerate("xyz")
    }


def _frame(mark: str) -> str:
    return {"": "the fixed frame", MARKED: "the moving frame"}.get(mark, f"the frame {mark}")
