"""Which known formulas the name of a claim's quantity allows: I_xy allows those named "product of inertia .."."""

import re
from collections.abc import Sequence
from functools import cache

from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.tree import TIME, Node, walk
from symrot.checker.recognition.single_faults.letters import is_atom
from symrot.checker.repair.filter import matrix_entries

__all__ = ["MOST_COMPONENTS", "has_terms", "has_word", "names_in", "quantities_in", "quantity_name", "words_of"]

AXIS_OF_MATRIX = "axis of a rotation matrix"

QUANTITIES: tuple[tuple[str, tuple[str, ...]], ...] = (
    (r"I(_bar)?_?(xy|yx|yz|zy|xz|zx|12|21|23|32|13|31)", ("product of inertia",)),
    (r"[IJ](_bar)?_?(p|t|s|a|c|g|cm|0|n|[xyzOPQGC1-3A-D]|([xyz1-3]_?[1-3]?)\3)?",
     ("moment of inertia", "inertia tensor", "parallel-axis")),
    (r"(omega|w|Omega)_?(p|pr|prec)",
     ("precession", "rate at which the angular velocity", "rate of spin of a free symmetric body")),
    (r"w", ("angular velocity", "precession", "spin", "rate at", "frequency", "quaternion", AXIS_OF_MATRIX)),
    (r"(omega|w)_?[xyz1-3]",
     ("angular velocity", "precession", "spin", "rate at", "frequency", AXIS_OF_MATRIX)),
    (r"(omega|w|Omega)(_?[a-zA-Z0-3]+)?|n|lambda", ("angular velocity", "precession", "spin", "rate at", "frequency")),
    (r"[pqr]", ("angular velocity", "angle rates", "distance of", "vector", "Rodrigues", "quaternion")),
    (r"(d(phi|theta|psi|alpha|gamma)|(phi|theta|psi)_?dot)(_?[1-3])?", ("angle rates", "precession", "spin")),
    (r"dbeta(_?[0-4])?", ("angle rates", "quaternion rates")),
    (r"(q|beta|e|eps|epsilon|eta)_?[0-4iswxyz]",
     ("quaternion", "Rodrigues parameters of", AXIS_OF_MATRIX)),
    (r"d(omega|w|Omega)(_?[xyz1-3])?|d[pr]", ("Euler's equations", "angular acceleration")),
    (r"dq", ("Euler's equations", "angular acceleration", "Rodrigues", "quaternion")),
    (r"theta|phi|psi|Phi|vartheta|varphi", ("angle of", "angle at")),
    (r"alpha(_?[xyz1-3])?|d(dphi|dtheta|dpsi)", ("angular acceleration",)),
    (r"a_?[xyz1-3]", ("acceleration", "frequency", AXIS_OF_MATRIX)),
    (r"a(_?[a-zA-Z0-9]+)?", ("acceleration", "frequency")),
    (r"v(_?[a-zA-Z0-9]+)?", ("speed", "velocity of", "product", "vector")),
    (r"T(_?rot)?|K|K_?E|E(_?(k|kin|rot))?|KE",
     ("kinetic energy", "torque", "rotation matrix", "period", "energy of", "Jacobian", "tension of")),
    (r"d(T|E|K|KE|W)", ("power",)), (r"sigma(_?[1-3i])?", ("modified Rodrigues",)),
    (r"(V|U)_?eff", ("effective potential",)),
    (r"W", ("work", "potential", "energy")),
    (r"V|U|E_?p|PE", ("potential", "work")),
    (r"d[LHhM](_?([xyzOGCPAB0-3]|cm))?", ("rate of the angular momentum",)),
    (r"H", ("angular momentum", "energy of")), (r"[Hh](_?([xyzOGCPAB0-3]|cm))?", ("angular momentum",)),
    (r"L(_?([xyzOGCPAB0-3]|cm))?", ("angular momentum", "Lagrangian", "torque")),
    (r"p_?(phi|theta|psi|varphi)|P_?(phi|theta|psi)", ("momentum of",)),
    (r"M", ("torque", "angular momentum of", "gyroscopic couple")),
    (r"(M|N|tau|Gamma|Q)(_?[a-zA-Z1-3]+)?", ("torque", "gyroscopic couple")),
    (r"P(_?rot)?", ("power",)), (r"e", ("angle", "energy")),
    (r"k_?[xyz1-3]", ("radius of gyration", AXIS_OF_MATRIX)),
    (r"[kK](_?[a-zA-Z0-3]+)?", ("radius of gyration", "kinetic energy")),
    (r"dq_?[0-4swxyz]?|d(e|eta|epsilon)_?[0-3]?", ("quaternion",)),
)  # fmt: skip
"""Pattern of a quantity's name -> words; the name of a known formula for the quantity contains one of these words.

The name of a rate begins with ``d``. The first pattern that matches counts. A quantity whose name matches no pattern
may have any formula.
"""

OF_MATRICES = ("inertia tensor", "rotation matrix", "Jacobian", "quaternion")
"""Words for quantities that are matrices."""

OF_VECTORS = ("rotated vector", "vector part")
"""Words for quantities that are vectors, which any letter may name."""

MOST_COMPONENTS = 4
"""The largest number of components of a vector; a matrix with more entries is no torque or momentum, whatever its
letter.
"""


def has_word(known: str, words: Sequence[str] | None) -> bool:
    """Return whether ``known``, the name of a known formula, contains one of ``words``. True if ``words`` is None."""
    # "velocity" does not stand for "angular velocity"
    return words is None or _pattern(tuple(words)).search(known) is not None


@cache
def _pattern(words: tuple[str, ...]) -> re.Pattern[str]:
    return re.compile(f"(?<!angular )(?:{'|'.join(map(re.escape, words))})")


def has_terms(formula: Node) -> bool:
    """Return whether a formula contains a sum, or a list such as the rows of a matrix."""
    return any(node.kind in ("sum", "list") for _, node in walk(formula))


def quantities_in(formula: Node) -> set[Node]:
    """Return the symbols, functions of time and rates in a formula; phi and its rate count as two."""
    if is_atom(formula):
        return set() if formula.value in ("pi", "t") else {formula}
    return {quantity for part in formula.args for quantity in quantities_in(part)}


def names_in(formula: Node) -> set[str]:
    """Return the names of the symbols and functions of time in a formula: m and phi for ``m*phi(t)``."""
    return {
        str(node.value)
        for _, node in walk(formula)
        if (node.kind == "name" and node.value != "t") or (node.kind == "call" and node.args == (TIME,))
    }


def words_of(named: NamedFormula) -> tuple[str, ...] | None:
    """Return words for a claim's quantity, ("product of inertia",) for I_xy.

    The name of a known formula for the quantity contains one of these words. Return None if the quantity's name has no
    usual meaning, or one that does not fit the claim's matrix.
    """
    words = _words_of_name(quantity_name(named))
    if words and any(node.kind == "call" and node.value == "cross" for _, node in walk(named.formula)):
        words = (*words, *OF_VECTORS)  # w = u cos(a) + ...: any letter may be the name of a vector
    is_matrix_of_rows = named.formula.value == "Matrix" and len(matrix_entries(named.formula)) > MOST_COMPONENTS
    return None if words and is_matrix_of_rows and not {*words} & {*OF_MATRICES} else words


@cache
def _words_of_name(name: str) -> tuple[str, ...] | None:
    return next((words for pattern, words in QUANTITIES if re.fullmatch(pattern, name)), None)


def quantity_name(named: NamedFormula) -> str:
    """Return the name of a claim's quantity: L for ``L = ..``, dL for ``L' = ..``."""
    name, dots = re.subn("_?dot$", "", re.sub("_(plus|minus)$|(_prime)+$", "", named.name))
    return f"d{name}" if named.is_rate or dots else name
