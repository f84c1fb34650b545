"""Integrals over time that equal the change of a quantity, ``∫ M dt = ΔL``, read as ``M = dL/dt``."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

from symrot.checker.claim.solving import terms_of
from symrot.checker.claim.tree import TIME, Node, differentiated, negated, nodes_of, product, without_sign
from symrot.checker.typed.readings import Reading, Relation
from symrot.errors import InputError

__all__ = ["BEGIN", "END", "with_rates"]

BEGIN, END = "t_initial", "t_final"
"""Names for the limits of an integral over time that is written without limits."""

NOTE = "an integral over time is the change of a quantity whose rate is the integrand"
EXPECTED = (
    "expected the change of a quantity beside an integral over time, such as ΔL, L_2 - L_1 or I ω_2 - I ω_1 "
    "(or limits, as in ∫_0^T M dt)"
)
SUFFIX = re.compile(r"(?P<base>[A-Za-z]+?)_?(?P<mark>[0-9a-zA-Z]|initial|final|begin|end|before|after)")
LATER = ("2", "f", "b", "B", "1", "final", "end", "after")
EARLIER = ("1", "i", "a", "A", "0", "initial", "begin", "before")


def with_rates(reading: Reading) -> Reading:
    """Return a reading (interpretation of a text) with ``M = diff(L, t)`` in place of lines such as ``∫ M dt = ΔL``.

    Raises
    ------
    InputError
        If a line has an integral over time without limits, and does not equate this integral to the change of a
        quantity.
    """
    lines, vectors, notes = [], dict(reading.vectors), list(reading.notes)
    for chain in reading.lines:
        relation = chain.links[0]
        made = _by_rate(relation, vectors) if len(chain.sides) == 2 and relation[0] == "==" else None
        if made is None:
            if any(BEGIN in [n.value for n in nodes_of(side)] for side in chain.sides):
                raise InputError(EXPECTED)
            lines.append(chain)
            continue
        (_, left, right), name = made
        if name in {strip for own in vectors if (strip := _base(own))} or name in vectors:
            vectors.setdefault(name, False)
        lines.append(replace(chain, sides=(left, right)))
        notes.append(NOTE)
    return replace(reading, lines=tuple(lines), vectors=vectors, notes=tuple(notes))


def _by_rate(relation: Relation, vectors: Mapping[str, bool]) -> tuple[Relation, str] | None:
    """Return ``M = diff(L, t)`` and the name L for ``L_1 + ∫ M dt = L_2``; None for other equations."""
    terms = [*terms_of(relation[1]), *(negated(term) for term in terms_of(relation[2]))]
    integrals = [term for term in terms if _integrand(term) is not None]
    if len(integrals) != 1:
        return None
    (integral,) = integrals
    inside = _integrand(integral)
    assert inside is not None
    others = [term for term in terms if term is not integral]
    if integral.kind != "neg":
        others = [negated(term) for term in others]
    rate = _rate_of_change(others, vectors)
    return None if rate is None else (("==", inside, rate[0]), rate[1])


def _integrand(term: Node) -> Node | None:
    """Return M if a term is ``∫ M dt`` or ``-∫ M dt`` and M does not contain t; None for any other term."""
    bare = without_sign(term)
    if bare.kind != "call" or bare.value != "integrate" or len(bare.args) != 2:
        return None
    inside, limits = bare.args
    is_open = TIME not in nodes_of(inside)
    return inside if is_open and limits.kind == "list" and limits.args[0] == TIME else None


def _rate_of_change(terms: Sequence[Node], vectors: Mapping[str, bool]) -> tuple[Node, str] | None:
    """Return the rate of change of a quantity from its change during a time, and the name of the letter that changes.

    ``terms`` are the change as a sum, ``I*omega_2 - I*omega_1``, or as a product, ``I*Delta_omega``; both give
    ``I*diff(omega, t)`` and omega. ``vectors`` has the names of vectors. Return None if the terms are no change of a
    quantity.
    """
    if len(terms) == 1:
        (term,) = terms
        factors = list(term.args) if term.kind == "product" else [term]
        for place, factor in enumerate(factors):
            after = factors[place + 1] if place + 1 < len(factors) else None
            if factor.kind == "name" and str(factor.value).startswith("Delta_"):
                name, rest = str(factor.value).removeprefix("Delta_"), [*factors[:place], *factors[place + 1 :]]
            elif factor.value == "Delta" and after is not None and after.kind == "name":
                name, rest = str(after.value), [*factors[:place], *factors[place + 2 :]]
            elif factor.kind == "sum" and (inner := _rate_of_change(factor.args, vectors)) is not None:
                return product([*factors[:place], inner[0], *factors[place + 1 :]]), inner[1]
            else:
                continue
            return product([*rest, _derivative(name, name in vectors)]), name
        return None
    if len(terms) != 2 or [term.kind == "neg" for term in terms].count(True) != 1:
        return None
    later, earlier = sorted(terms, key=lambda term: term.kind == "neg")
    factors, befores = (list(t.args) if t.kind == "product" else [t] for t in (later, earlier.args[0]))
    changed = [(a, b) for a, b in zip(factors, befores, strict=False) if a != b]
    if len(factors) != len(befores) or len(changed) != 1:
        return None
    last, first = changed[0]
    ended, began = SUFFIX.fullmatch(str(last.value)), SUFFIX.fullmatch(str(first.value))
    if last.kind != "name" or ended is None or began is None or ended["base"] != began["base"]:
        return None
    if ended["mark"] not in LATER or began["mark"] not in EARLIER:
        return None
    name, place = ended["base"], factors.index(last)
    rate = _derivative(name, str(last.value) in vectors)
    return product([*factors[:place], rate, *factors[place + 1 :]]), name


def _derivative(name: str, is_vector: bool) -> Node:
    """Return ``diff(L, t)`` for a vector L, ``diff(L(t), t)`` for a number."""
    inner = Node("name", name) if is_vector else Node("call", name, (TIME,))
    return differentiated(inner, TIME)


def _base(name: str) -> str:
    match = SUFFIX.fullmatch(name)
    return match["base"] if match else ""
