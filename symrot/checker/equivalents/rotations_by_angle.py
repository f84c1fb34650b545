r"""Equations between rotations by angles about one axis, ``R(\alpha) R(\beta) = R(\alpha + \beta)``."""

import re

__all__ = ["with_axis"]

ANGLE = (
    r"\\?(?:alpha|beta|gamma|delta|theta|phi|varphi|psi|pi)(?![a-z])|[αβγδθφϕψπ]|[0-9]+|[-−+*·/ ₁₂]|_\{?[0-9]\}?|\\,"
)
CALL = re.compile(
    rf"(?P<name>(?:\\(?:mathbf|mathrm|boldsymbol|bm)\s*\{{\s*R\s*\}}|(?<![A-Za-z\\{{])R))\s*(?P<open>\\left)?\((?P<angle>(?:{ANGLE})+)(?:\\right)?\)"
)
"""Pattern of a rotation by an angle, such as ``R(\\alpha + \\beta)``."""

OTHERS = re.compile(
    r"(?:=|\^|[IE1]|\{\s*(?:T|-1|\\top|[0-9])\s*\}|T|-1|⁻¹|[²³ᵀ0-9·*$\s]|\\cdot|\\,|\\mathbf\{I\}|\\top)+"
)
"""Pattern of the rest of an equation whose rotations ``R(..)`` are cut out: signs, powers, numbers, the unit matrix.

An equation with any other rest, such as ``R(\\theta) = A``, has more in it than rotations.
"""

NOTE = "R(..) is read as the rotation by an angle in a plane, or about one fixed axis, here z"


def with_axis(source: str) -> tuple[str, str]:
    """Return (text, note): an equation between rotations with ``R_z(..)`` for each ``R(..)``, and a note for the user.

    The equation must have at least two different angles, or a number as its only angle, as ``R(π)^2 = I`` has. Return
    any other text unchanged, with an empty note.

    Examples
    --------
    >>> with_axis("R(α) R(β) = R(α + β)")[0], with_axis("R(θ) = Rz(θ)")[0]
    ('R_z(α) R_z(β) = R_z(α + β)', 'R(θ) = Rz(θ)')
    """
    calls = list(CALL.finditer(source))
    angles = {"".join(call["angle"].split()) for call in calls}
    is_of_number = len(angles) == 1 and re.fullmatch(r"[0-9\\piπ]+", "".join(angles)) is not None
    if OTHERS.fullmatch(CALL.sub("", source)) is None or not (len(angles) > 1 or is_of_number):
        return source, ""
    return CALL.sub(lambda call: f"R_z({call['angle']})", source), NOTE
