"""Names of moments of inertia that name the body, ``I_rod``: only a formula of that body is the one that is meant."""

import re
from dataclasses import replace

from symrot.checker.verdict import Verdict

__all__ = ["of_named_body"]

BODIES = {
    "rod": "rod", "stick": "rod", "bar": "rod", "sphere": "spher|ball", "ball": "spher|ball", "shell": "shell",
    "disk": "disk", "disc": "disk", "cylinder": "cylinder", "cone": "cone", "ring": "ring|hoop", "hoop": "ring|hoop",
    "plate": "plate", "box": "box|cube", "cube": "box|cube", "ellipsoid": "ellipsoid", "torus": "torus",
}  # fmt: skip
"""A word at the end of a name -> the words of which one must be in the title of the formula."""


def of_named_body(name: str, verdict: Verdict) -> Verdict:
    """Return ``verdict``, "recognised", with only the formulas of the body that ``name`` names; "definition" if none is
    left. Other verdicts, and names without a body, are unchanged.
    """
    word = re.fullmatch(r"[IJ]_(?:\w+_)?([a-z]+?)", name)
    if verdict.verdict != "recognised" or word is None or word[1] not in BODIES:
        return verdict
    fitting = tuple(known for known in verdict.recognised_as if re.search(BODIES[word[1]], known.name))
    if fitting:
        return replace(verdict, recognised_as=fitting)
    other = verdict.recognised_as[0].name if verdict.recognised_as else "another body"
    reason = f"the name says {word[1]}, and the formula is the {other}"
    return replace(verdict, verdict="definition", recognised_as=(), reason=reason)
