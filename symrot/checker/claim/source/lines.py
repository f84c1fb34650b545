"""The claims of a text with several lines, or with a chain of equals signs such as ``a = b = c``."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from symrot.checker.arrays.complex_parts import BAR, imaginary_unit, open_numbers, with_numbers
from symrot.checker.claim.claims import Claim
from symrot.checker.claim.reader import readings_of
from symrot.checker.claim.source.impulses import with_rates
from symrot.checker.claim.source.text import check_units, claim_of_relation, is_latex, names_in_hypotheses
from symrot.checker.claim.tree import TIME, Node, is_derivative, names_in, nodes_of
from symrot.checker.claim.vectors import used_vectors
from symrot.checker.context.context import NO_CONTEXT, Context, quantities_of
from symrot.checker.equivalents.product_signs import sign_by_integral, with_sign
from symrot.checker.latex.reader import latex_readings
from symrot.checker.typed.readings import Chain, Reading
from symrot.errors import InputError

__all__ = ["claims_of_reading"]

CIRCULAR = ("sin", "cos", "tan")
MOST_EQUATIONS = 30
"""The largest number of equations in one text; ``a = b = c`` counts as two."""


def claims_of_reading(
    reading: Reading, source: str, assume: Sequence[str] = (), units: Mapping[str, str] | None = None,
    stated: Context = NO_CONTEXT,
) -> list[list[Claim]]:  # fmt: skip
    """Return the claims of one reading (interpretation) of a text: for each line, one claim per equals sign.

    ``stated`` is what the user says in words about names and the body.
    """
    define: list[tuple[str, Node]] = []
    lines = []
    reading = with_rates(reading)
    reading = replace(reading, lines=_with_substitutions_first(reading.lines))
    if sum(len(chain.links) for chain in reading.lines) > MOST_EQUATIONS:
        raise InputError(f"expected at most {MOST_EQUATIONS} equations in one text; a file of claims may have more")
    names = {str(n.value) for chain in reading.lines for n in nodes_of(*chain.sides)}
    check_units(dict(units or {}), names, "claim")
    units = {**stated.units(names - {*reading.vectors}, units or {}), **(units or {})}
    quantities = {name for chain in reading.lines for side in chain.sides for name in quantities_of(side)}
    stated.check_names(quantities, names_in_hypotheses(assume) if stated.meanings else set())
    context = [side for chain in reading.lines for side in chain.sides]
    numbers = _complex_numbers(reading.lines, context)
    if numbers and all(unit.kind == "name" for unit in numbers.values()):
        context = [with_numbers(side, numbers) for side in context if side.kind != "name"]
    assume, stated = _with_signs_of_products(assume, stated)
    has_time = any(is_derivative(n) or n.args == (TIME,) for n in nodes_of(*context))
    for chain in reading.lines:
        links = chain.links
        if len(links) > 1 and set(chain.signs) != {"=="}:
            raise InputError(f"expected a chain of equals signs, got {' '.join(chain.signs)!r} in {source[:60]!r}")
        used = {str(n.value) for n in nodes_of(*chain.sides) if n.kind in ("name", "call")}
        used |= {name.removesuffix(BAR) for name in used} & {*numbers}  # the conjugate of z needs z
        known = _needed(define, used)
        known += [
            item for item in numbers.items() if item[0] in used and item not in define and item[1] not in chain.sides
        ]
        claims = []
        for link in links:
            in_link = {str(n.value) for n in nodes_of(*link[1:])}
            own = {name: unit for name, unit in (units or {}).items() if name in in_link}
            vectors = [vector for vector in used_vectors(link[1:], reading.vectors) if vector.name not in dict(define)]
            if numbers and not (link[1].kind == "name" and numbers.get(str(link[1].value)) == link[2]):
                link = link[0], with_numbers(link[1], numbers), with_numbers(link[2], numbers)
            claim = claim_of_relation(link, source, assume, own, known, reading.notes, context, vectors)
            claims.append(replace(claim, context=stated))
        lines.append(claims)
        first = chain.sides[0]
        if sign := sign_by_integral(first, chain.sides[1]):
            stated = with_sign(stated, first, sign)
            continue
        reserved = ("pi", *(["t"] if has_time else []), *(name for name, _ in define))
        # a line that gives a formula for a name defines this name for the lines after it
        is_name = first.kind == "name" and chain.signs[0] == "==" and first.value not in reserved
        if is_name and not chain.both_signs and first not in nodes_of(chain.sides[1]):
            define.append((str(first.value), chain.sides[1]))
    return lines


def _with_substitutions_first(lines: Sequence[Chain]) -> tuple[Chain, ...]:
    """Return lines with ``u = tan(theta/2)`` before ``sin(theta) = 2*u/(1 + u**2)``, which uses u."""
    of_angles = [line for line in lines if line.sides[0].kind == "call" and line.sides[0].value in CIRCULAR]
    used = {str(node.value) for line in of_angles for node in nodes_of(*line.sides)}
    first = [line for line in lines if line.sides[0].kind == "name" and line.sides[0].value in used]
    return (*first, *(line for line in lines if line not in first))


def _with_signs_of_products(assume: Sequence[str], stated: Context) -> tuple[list[str], Context]:
    """Return the hypotheses except definitions such as ``I_xy = -∫ x y dm``, and the context with the sign of products
    of inertia that these definitions state.
    """
    others = []
    for source in assume:
        readings = latex_readings(source) if is_latex(source) else readings_of(source, "given")
        left, right = readings[0].lines[0].sides[:2]
        # such a hypothesis says only whether products of inertia have the minus sign
        if sign := sign_by_integral(left, right):
            stated = with_sign(stated, left, sign)
        else:
            others.append(source)
    return others, stated


def _complex_numbers(lines: Sequence[Chain], formulas: Sequence[Node]) -> dict[str, Node]:
    """Return {"z": formula} for the complex numbers z of a text.

    If lines define such numbers by formulas with i, such as ``z = x + i*y``, these formulas are returned. If the text
    only gives another name to i, as the lines ``q = i`` and ``q^2 = -1`` do, return {"q": i}. Otherwise the formula of
    a complex number z is ``Re_z + i*Im_z``.
    """
    unit = imaginary_unit(formulas)
    if unit is None:
        return _names_of_unit(lines, formulas) or open_numbers(formulas)
    numbers = {
        str(chain.sides[0].value): chain.sides[1]
        for chain in lines
        if len(lines) > 1
        and chain.sides[0].kind == "name"
        and unit.value in {n.value for n in nodes_of(chain.sides[1])}
    }
    own = {name: tree for name, tree in numbers.items() if name.removesuffix(BAR) not in numbers or BAR not in name}
    return own or open_numbers(formulas, str(unit.value))


def _names_of_unit(lines: Sequence[Chain], formulas: Sequence[Node]) -> dict[str, Node]:
    """Return the names that lines give to the imaginary unit: {"q": i} for the two lines ``q = i`` and ``q^2 = -1``.

    Return {} for a single line, and if the formulas have any letter besides q and i (or j).
    """
    first = {chain.sides[0]: chain.sides[1] for chain in lines if chain.sides[0].kind == "name" and len(lines) > 1}
    named = {str(name.value): side for name, side in first.items() if side in (Node("name", "i"), Node("name", "j"))}
    letters = {str(node.value) for node in nodes_of(*formulas) if node.kind in ("name", "call")}
    return named if letters - {*named} == {str(side.value) for side in named.values()} else {}


def _needed(define: Sequence[tuple[str, Node]], used: set[str]) -> list[tuple[str, Node]]:
    """Return, in order, the definitions on which the names ``used`` depend, directly or through other definitions."""
    inside = {name: names_in(tree) for name, tree in define}
    trees = dict(define)
    needed: list[str] = []

    def add(name: str, above: tuple[str, ...]) -> None:
        for other in sorted(inside.get(name, set()) - {*above, name}):
            add(other, (*above, name))
        if name in trees and name not in needed:
            needed.append(name)

    for name in [name for name, _ in define if name in used]:
        add(name, ())
    return [(name, trees[name]) for name in needed]
