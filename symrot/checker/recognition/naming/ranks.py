"""Ranks of known formulas: how well their names and letters fit a claim, and how often books print them."""

import re
from itertools import pairwise

from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.context.admission import COMPONENTS
from symrot.checker.context.angle_orders import USUAL_SEQUENCES
from symrot.checker.recognition.naming.fit import ENTRY
from symrot.checker.recognition.naming.quantities import quantity_name
from symrot.checker.verdict import Identification
from symrot.conventions import SEQUENCES

__all__ = ["RARE", "is_in_usual_sequence", "misfit_of", "rarity_of", "strangeness_of"]

RARE = ("annulus", "thin tube", "conical shell", "elliptical")
"""Words in the names of bodies whose moments a faulty formula is unlikely to mean."""

AXES = ("x1Ap", "y2Bq", "z3Cr")
"""For each of three axes, the last characters of symbols that belong to the axis: omega_x, I_1, A and p belong to the
first axis. The letters p, q and r are the rates of an aircraft."""


def misfit_of(name: str, known: str) -> float:
    """Return how badly a known formula's name ``known`` fits the quantity ``name``: a larger number is worse."""
    sequence = _rank_of_sequence(known) / (2 * len(USUAL_SEQUENCES))
    # "first component .." does not fit to omega_3, nor "entry 22 .." to R_11
    own, entry = re.fullmatch(ENTRY, name), re.match("entry ([1-3]{2}) of", known)
    is_other_entry = own is not None and entry is not None and entry[1] != own[1]
    return _misplaced(name, known) + is_other_entry + any(body in known for body in RARE) + sequence


def _misplaced(name: str, known: str) -> int:
    """Return how often a formula's name ``known`` contradicts the quantity ``name``: in the component, or in the frame.

    "first component in the space frame" contradicts omega_3 in both.
    """
    words = known.replace(",", "").split()
    places = [COMPONENTS[word] for word, after in pairwise([*words, ""]) if word in COMPONENTS and
              (after in ("component", "axis"))]  # fmt: skip
    # another component or axis
    misnamed = any(name[-1] in "".join(COMPONENTS.values()) and name[-1] not in letters for letters in places)
    # the space frame, for letters that books use in the body frame
    turned = re.fullmatch(r"[pqr]|(omega|w)_?[1-3]", name) is not None and "space frame" in known
    return int(misnamed) + int(turned)


def strangeness_of(named: NamedFormula, known: Identification) -> tuple[int, int, int]:
    """Return a sort key for known formulas, smallest for the one that fits the names in a claim best."""
    axes = [[next((n for n, axis in enumerate(AXES) if name[-1] in axis), None) for name in pair]
            for pair in known.mapping.items()]  # fmt: skip
    moved = sum(None not in pair and pair[0] != pair[1] for pair in axes)
    # wrong components and frames, symbols of another axis, renamed symbols
    return _misplaced(quantity_name(named), known.name), moved, len(known.mapping)


def rarity_of(known: Identification) -> tuple[bool, int]:
    """Return a sort key for known formulas, smallest for those that books print most often."""
    # equal formulas before transposed ones or multiples; usual Euler sequences before others
    return bool(known.how), _rank_of_sequence(known.name)


def is_in_usual_sequence(known: str) -> bool:
    """Return whether a known formula's name has no sequence of Euler angles, or one that books often use."""
    return _rank_of_sequence(known) < len(USUAL_SEQUENCES)


def _rank_of_sequence(known: str) -> int:
    """Return how rare the Euler sequence in a known formula's name is: 0 for the most usual one, or for none."""
    sequences = [word for word in known.split() if word in SEQUENCES]
    usual = [USUAL_SEQUENCES.index(name) if name in USUAL_SEQUENCES else len(USUAL_SEQUENCES) for name in sequences]
    return max(usual, default=0)
