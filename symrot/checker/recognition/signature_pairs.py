"""Ways to pair the symbols of two formulas that may be equal up to the names of symbols, the most plausible first.

Such formulas have equal fingerprints: hashes of their values, which do not depend on the names.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from itertools import islice, permutations, product

from sympy import Expr

from symrot.checker.recognition.fingerprint import Fingerprint, Values
from symrot.checker.recognition.renaming import axes_of
from symrot.checker.recognition.usual_letters import plain_name, unit_of
from symrot.exact.printing import as_text

__all__ = ["MOST_TRIES", "name_of", "pairings"]

MOST_TRIES = 720
"""The largest number of ways to pair the symbols of two formulas that are tried.

It also limits the ways to pair the symbols of one group. A group has the symbols with equal signatures, which
:class:`Fingerprint` describes; only these can be paired with each other.
"""


@lru_cache(maxsize=4096)  # thousands of renamings of one claim need the same texts
def name_of(atom: Expr) -> str:
    """Return the text of a symbol or rate, such as ``omega_1`` or ``diff(phi(t), t)``."""
    return as_text(atom)


def pairings(theirs: Fingerprint, own: Fingerprint, order: Sequence[int]) -> Iterator[dict[Expr, Expr]]:
    """Yield {symbol of a known formula: symbol of a claim's formula} for the ways to pair all their symbols.

    ``theirs`` is the fingerprint of the known formula, ``own`` that of the claim's formula. A fingerprint has for each
    symbol a signature, numbers that do not depend on the symbol's name; only symbols with equal signatures are paired.
    Yield nothing if that leaves symbols unpaired. For matrices, entry i of the known formula is compared with entry
    ``order[i]`` of the claim's formula.
    """
    mine: dict[Values, list[Expr]] = {}
    for atom, row in zip(own.atoms, own.scaled_signatures(order), strict=True):
        mine.setdefault(row, []).append(atom)
    groups: dict[Values, list[Expr]] = {}
    for atom, row in zip(theirs.atoms, theirs.scaled_signatures(range(len(theirs.signatures[0]))), strict=True):
        groups.setdefault(row, []).append(atom)
    if {row: len(atoms) for row, atoms in mine.items()} != {row: len(atoms) for row, atoms in groups.items()}:
        return
    choices = []
    own_names = {plain_name(name_of(atom)) for atom in own.atoms}
    # symbols with the names of the known formula stay as they are while the orders of the others are tried
    ordered_groups = sorted(groups.items(), key=lambda group: not {*map(name_of, group[1])} <= own_names)
    for row, atoms in ordered_groups:
        names = {name_of(atom) for atom in atoms}
        ordered = sorted(mine[row], key=lambda atom: (name_of(atom) not in names, name_of(atom)))
        choices.append([(atoms, chosen) for chosen in _nearest(atoms, ordered)])
    for chosen in product(*choices):
        yield {a: b for atoms, others in chosen for a, b in zip(atoms, others, strict=True)}


def _nearest(atoms: Sequence[Expr], others: Sequence[Expr]) -> list[tuple[Expr, ...]]:
    """Return the symbols ``others`` in at most MOST_TRIES orders, the most plausible order first.

    In each order, the symbols are to be paired one by one with ``atoms``, the symbols of another formula.
    """
    known = {atom: (name_of(atom), unit_of(name_of(atom))) for atom in (*atoms, *others)}

    def difference(atom: Expr, other: Expr) -> int:
        (name, unit), (own, own_unit) = known[atom], known[other]
        contradicting = None not in (unit, own_unit) and unit != own_unit
        # a sum of these is ordered by contradicting units, then by other names, then by other first letters
        return (contradicting << 40) + ((name != own) << 20) + (name[0].lower() != own[0].lower())

    differences = [{other: difference(atom, other) for other in others} for atom in atoms]
    orders = islice(permutations(_likeliest(atoms, others, known)), MOST_TRIES)
    return sorted(orders, key=lambda order: sum(row[other] for row, other in zip(differences, order, strict=True)))


def _likeliest(
    atoms: Sequence[Expr], others: Sequence[Expr], known: Mapping[Expr, tuple[str, str | None]]
) -> list[Expr]:
    """Return the symbols ``others`` in the order that suits ``atoms``, the symbols of another formula.

    Each symbol has, if possible, the unit, name, first letter and axis of the atom at the same position. ``known`` maps
    each symbol to its name and unit.
    """
    # for many symbols the caller cannot try all orders, and begins with this one
    rest, ordered = list(others), []
    names = {plain_name(known[atom][0]) for atom in atoms}
    for atom in atoms:
        name, unit = plain_name(known[atom][0]), known[atom][1]
        axes = axes_of(name)
        costs = []
        for place, other in enumerate(rest):
            own, own_unit = plain_name(known[other][0]), known[other][1]
            is_other_unit = None not in (unit, own_unit) and unit != own_unit
            is_other_axis = bool(axes) and axes_of(own) != axes
            is_other_letter = own[0].lower() != name[0].lower()
            costs.append((is_other_unit, own != name, own in names, is_other_letter, is_other_axis, place))
        ordered.append(rest.pop(min(costs)[-1]))
    return ordered
