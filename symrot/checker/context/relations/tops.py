"""Claims about a symmetric top that mix spin, momenta and rates: ``p_phi = I_1 phi' sin^2 theta + I_3 s cos theta``.

Momenta, spin and energies are formulas in the independent quantities: angles, their rates, moments and weight. Books
use n and s in two meanings: the spin omega_3 = psi' + phi' cos theta, which is the component of the angular velocity
along the axis, and the rate psi' of the spin angle. Both meanings are tried.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import islice, product

from sympy import Expr, Matrix, S, Symbol, cos, diag, expand, sin

from symrot import symbols
from symrot.checker.claim.interpreter import atoms_of, time
from symrot.checker.context.admission import plain
from symrot.checker.context.bodies import TOPS
from symrot.checker.context.context import Context
from symrot.checker.context.relations.substitution import Substitution
from symrot.exact.printing import as_text
from symrot.kinematics.euler import rate_jacobian

__all__ = ["MOMENT_LETTERS", "substitutions_of_tops"]

THETA, (DPHI, DTHETA, DPSI) = symbols.theta, symbols.angle_rates
A, C, ARM, MASS, GRAVITY, WEIGHT = symbols.A, symbols.C, symbols.c_3, symbols.m, symbols.g, symbols.W
HEAVY = "derivations/heavy_top.md"
MOST_CHOICES = 64

COORDINATES: tuple[tuple[str, Expr], ...] = (
    ("theta|vartheta", THETA), ("d(theta|vartheta)", DTHETA), ("d(phi|varphi)|Omega(_?p)?|omega_?p", DPHI),
    ("dpsi|omega_?s|s|n|nu|omega|Omega", DPSI),
    (r"A|I|[IJ]_?([012tx]|xx|yy|perp)|I_prime", A), (r"C|[JI]|[IJ]_?([3sz]|zz)", C),
    ("m|M", MASS), ("g", GRAVITY), (r"l|ell|h|a|R|d|r|[lrh]_?(G|cm|C)|z_?(G|C|cm)", ARM), ("W|mg", WEIGHT),
)  # fmt: skip
"""Pairs (pattern of letters, symbol) for what a letter of a claim about a top can mean: an angle, the rate of one, a
moment of inertia, or a mass, g, a length or a weight. Other quantities of a top are formulas in these symbols."""
MOMENT_LETTERS = {symbol: letters for letters, symbol in COORDINATES if symbol in (A, C)}

QUANTITIES: tuple[tuple[str, tuple[str, ...]], ...] = (
    (r"(omega|w|Omega)_?[3z]|omega_?s|[sSn]|nu|omega|Omega|r", ("spin along the axis",)),
    ("p_?(phi|varphi)|[LMHJ]_?z|[LMHJ]_?Z", ("momentum of precession",)), ("p_?psi|[LMHJ]_?3", ("momentum of spin",)),
    ("p_?(theta|vartheta)", ("momentum of nutation",)),
    ("T|T_?rot|K|K_?E|E_?(k|kin|rot)|KE", ("kinetic energy",)), ("V|U|E_?p|PE", ("potential energy",)),
    ("E", ("energy",)),
    ("dE|E_prime|E_?1", ("energy without the energy of the spin",)), ("L", ("Lagrangian",)),
    ("[VU]_?eff", ("effective potential", "effective potential without the energy of the spin")),
)  # fmt: skip
"""Pairs (pattern of letters, titles) for the quantities of a top, such as "kinetic energy", that a letter can mean."""

EVIDENT = ("momentum of precession", "momentum of spin", "effective potential", "spin along the axis")
"""Titles of quantities of a top: a claim with such a quantity and with the angle theta is about a top."""
CONJUGATE = re.compile("p_?(phi|varphi|theta|vartheta|psi)")


def substitutions_of_tops(context: Context, sides: Sequence[Expr]) -> Iterator[Substitution]:
    """Yield the possible meanings of the letters of a claim about a symmetric top, as Substitutions.

    Each Substitution replaces spin and momenta by formulas in the angles of the top and their rates.
    """
    if context.body is not None and context.body.kind.formulas != TOPS:
        return
    atoms = sorted(atoms_of(sides) - {time}, key=str)
    names = {atom: plain(as_text(atom)).replace("_dot", "") for atom in atoms}
    for load in (MASS * GRAVITY, WEIGHT):
        formulas = _formulas(load)
        choices = [[*_choices(context, name, formulas, load)] for name in names.values()]
        # a letter that means nothing for a top
        if not all(choices):
            continue
        for chosen in islice(product(*choices), MOST_CHOICES):
            values = dict(zip(atoms, (value for _, value in chosen), strict=True))
            own = [title for title, _ in chosen if title]
            if _is_fitting(names, values, own, has_body=context.body is not None):
                yield _substitution(names, values, own)
                yield from _of_steady_precession(names, values, sides, load)


def _substitution(names: Mapping[Expr, str], values: dict[Expr, Expr], own: Sequence[str]) -> Substitution:
    name = f"relation for a symmetric top: {', '.join(dict.fromkeys(own))}"
    return Substitution(name, HEAVY, values, mapping=_mapping(names, values))


def _mapping(names: Mapping[Expr, str], values: Mapping[Expr, Expr]) -> dict[str, str]:
    """Return a map from symbols of a top, such as A, to the claim's letters for them, as I_1, where they differ."""
    return {str(value): names[atom] for atom, value in values.items()
            if isinstance(value, Symbol) and str(value) != names[atom]}  # fmt: skip


def _is_fitting(names: Mapping[Expr, str], values: Mapping[Expr, Expr], own: Sequence[str], has_body: bool) -> bool:
    """Return whether ``values``, the meanings of a claim's letters, make it a claim about a top.

    At least one letter must mean a moment of inertia, and no two letters may have the same meaning. A body in the
    context (``has_body``), a letter such as p_theta, or the titles ``own`` of quantities in the claim, such as
    "momentum of spin", must show that the claim is about a top.
    """
    letters: dict[Expr, str] = {}
    same = all(letters.setdefault(value, names[atom]) == names[atom] for atom, value in values.items())
    moments = {A, C} & {*values.values()}
    is_evident = has_body or (any(title in EVIDENT for title in own) and THETA in values.values())
    is_evident = is_evident or any(map(CONJUGATE.fullmatch, names.values()))
    is_evident = is_evident or {"momentum of spin", "energy without the energy of the spin"} <= {*own}
    return same and bool(own) and bool(moments) and is_evident


def _choices(context: Context, name: str, formulas: Mapping[str, Expr], load: Expr) -> Iterator[tuple[str, Expr]]:
    """Yield a pair (title, formula) for each quantity of a top that the letter ``name`` can mean.

    For the letter s, one pair has the title "spin along the axis". The title is empty for a symbol of COORDINATES, such
    as the angle theta. ``formulas`` maps titles to formulas; ``load`` is the weight of the top, m*g or W.
    """
    meaning = context.meaning_of(name)
    pattern = meaning.quantity.symbols if meaning is not None else ""
    for letters, symbol in COORDINATES:
        is_used = symbol not in (MASS, GRAVITY, WEIGHT) or symbol in load.free_symbols
        if is_used and re.fullmatch(letters, name) and (not pattern or re.fullmatch(pattern, symbol.name)):
            # a coordinate such as theta has no title
            yield "", symbol
    for letters, titles in QUANTITIES:
        if re.fullmatch(letters, name):
            for title in titles:
                symbol = SYMBOL_OF.get(title, "")
                if not pattern or (symbol and re.fullmatch(pattern, symbol)):
                    yield title, formulas[title]


SYMBOL_OF = {
    "spin along the axis": "omega_3", "momentum of precession": "p_phi", "momentum of spin": "p_psi",
    "momentum of nutation": "p_theta", "kinetic energy": "E_k", "energy": "E_k", "potential energy": "E_k",
}  # fmt: skip
"""Maps the title of a quantity to the symbol that derived formulas use for it."""


@cache
def _formulas(load: Expr) -> dict[str, Expr]:
    """Return the formulas of a top's quantities by title, such as "kinetic energy", in its angles and their rates."""
    omega = (Matrix(rate_jacobian("ZXZ")) * Matrix(symbols.angle_rates)).subs(symbols.psi, 0)
    kinetic = expand(omega.dot(diag(A, A, C) * omega) / 2)
    potential = load * ARM * cos(THETA)
    # the momenta are derivatives of the kinetic energy with respect to the rates
    precession, nutation, spin = (kinetic.diff(rate) for rate in symbols.angle_rates)
    energy_of_spin = spin**2 / (2 * C)
    effective = kinetic + potential - nutation**2 / (2 * A)
    return {
        "spin along the axis": omega[2],
        "momentum of precession": precession,
        "momentum of nutation": nutation,
        "momentum of spin": spin,
        "kinetic energy": kinetic,
        "potential energy": potential,
        "energy": kinetic + potential,
        "energy without the energy of the spin": kinetic + potential - energy_of_spin,
        "Lagrangian": kinetic - potential,
        "effective potential": effective,
        "effective potential without the energy of the spin": effective - energy_of_spin,
    }


def _of_steady_precession(
    names: Mapping[Expr, str], values: Mapping[Expr, Expr], sides: Sequence[Expr], load: Expr
) -> Iterator[Substitution]:
    """Yield, for a claim ``phi' = f`` about steady precession, a Substitution with another equation to decide.

    That equation is Lagrange's equation for constant theta, with f in place of phi'. ``values`` maps the claim's
    letters to quantities of a top, and ``load`` is its weight, m*g or W.
    """
    for side, formula in (sides, sides[::-1]):
        if values.get(side) != DPHI or side in atoms_of([formula]):
            continue
        spin = Symbol("omega_3", real=True)
        mine = {atom: spin if atom != side and value == _formulas(load)["spin along the axis"] else value
                for atom, value in values.items()}  # fmt: skip
        if {DPHI, DPSI} & {value for atom, value in mine.items() if atom != side}:
            continue
        kinetic = _formulas(load)["kinetic energy"].diff(THETA).subs(DTHETA, 0).subs(DPSI, spin - DPHI * cos(THETA))
        # Lagrange's equation for theta at rest, divided by sin(theta)
        condition = expand(expand(kinetic - (load * ARM * cos(THETA)).diff(THETA)) / sin(THETA))
        # the condition is zero if the claim holds
        own = formula.xreplace(mine)
        condition = condition.subs(DPHI, own)
        name = "rate of steady precession of a heavy top"
        yield Substitution(name, HEAVY, {}, sides=(condition, S.Zero), mapping=_mapping(names, mine))
