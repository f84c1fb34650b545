"""The known formulas whose names fit a claim in its context, written in the letters of the claim.

A name such as "moment of inertia of a thin rod about an end" fits if it does not contradict the context, and if the
context or the claim's quantity states each of its words; only the point of the body may be left open.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import Any

from sympy import Dummy, Expr, Function, Rational, Symbol, sqrt

from symrot import symbols
from symrot.checker.claim.interpreter import atoms_of, time
from symrot.checker.claim.scope import is_matrix
from symrot.checker.context.admission import admits_letters, admits_name, guesses, is_component, is_place, plain
from symrot.checker.context.angle_orders import has_order
from symrot.checker.context.bodies import bodies_of_formula
from symrot.checker.context.context import Context
from symrot.checker.recognition.identification import known_value
from symrot.checker.recognition.known_formulas import Known, by_fingerprint
from symrot.checker.recognition.naming.readings import SQUARED
from symrot.checker.recognition.renaming import axes_of, component, is_consistent
from symrot.checker.verdict import Identification
from symrot.exact.printing import as_text

__all__ = ["ANGLE", "Meant", "all_known", "assignments_of", "meant_by", "with_letters"]

MOST_ASSIGNMENTS = 24
"""The largest number of assignments of a claim's letters to the symbols of one known formula; the claim is compared
with the formula for each assignment."""

MOST_CHOICES = 10_000
"""The largest number of assignments of a claim's letters to the symbols of one known formula that are tested. Most
assignments fail because they contradict the context or an index: I_x cannot be the moment of inertia about y."""

ANGLES = tuple(Symbol(symbol.name, real=True) for symbol in (*symbols.angles, *symbols.angle_rates))

SIDES = "a|b|c"
"""Pattern of the letters in derived formulas for the sides of a box, or the semi-axes of an ellipsoid: a along x, b
along y, c along z."""

ANGLE = "phi|theta|psi|alpha|beta|gamma|varphi|vartheta|theta_?[1-3]|q_?[1-3]"

USUAL: tuple[tuple[str, str], ...] = (
    ("m", r"m|M|mu|m_\w"), ("R", r"[rRa]|[rR]_?0"), ("L", r"[lLh]|ell"), ("h", r"[hHl]"), ("r", r"[rdlhR]|r_?[A-Z]"),
    ("R_1", r"R_?1|r_?1|R_?i|r_?i|a"), ("R_2", r"R_?2|r_?2|R_?o|r_?o|b"), (SIDES, SIDES),
    ("A", r"[IAJ]|[IJ]_?[01xt]|I_?xx|[IJ]_prime|lambda_?1"), ("B", r"B|[IJ]_?[2y]|I_?yy|lambda_?2"),
    ("C", r"[ICJ]|[IJ]_?[3zsG]|I_?zz|lambda_?3|[IJ]_?(O|cm)"),
    ("phi|theta|psi", ANGLE), ("dphi|dtheta|dpsi", f"d({ANGLE})"),
    *((f"omega_{axis}", rf"(omega|w|Omega)_?{pattern}|{letter}") for axis, pattern, letter in (
        ("1", "[1x]", "p"), ("2", "[2y]", "q"), ("3", "[3z]", "omega|w|r"), ("x", "[1x]", "p"), ("y", "[2y]", "q"),
        ("z", "[3z]", "omega|w|r"))),
    ("domega_1", "d(omega|w|Omega)_?[1x]|dp"), ("domega_2", "d(omega|w|Omega)_?[2y]|dq"),
    ("domega_3", "d(omega|w|Omega)_?[3z]|dr"),
    ("g", "g"), ("c_3", r"[lRhda]|[lrh]_?(G|cm)"), ("Omega|n", r"Omega|omega_?p|n|Omega_\w+"),
    ("H", r"[HLMh]|[HL]_?[GO]"), ("M|tau_[123]", r"[MNT]|tau|Gamma"), ("W", "W|mg"),
    ("L_1", "[LHM]_?[1x]"), ("L_2", "[LHM]_?[2y]"), ("L_3", "[LHM]_?[3z]"),
    ("p_phi", "p_?phi"), ("p_theta", "p_?theta"), ("p_psi", "p_?psi"),
    ("k_O", r"k|k_?[0O]|i"), ("v", "v|v_?[GO]|v_?cm"),
    ("omega_i", "omega_?[10i]"), ("omega_f", "omega_?[2f]|omega"), ("theta_i", "theta_?[10i]"),
    ("theta_f", "theta_?[2f]|theta"), ("alpha_a", "alpha"), ("t", "t|Delta_t"), ("beta", "theta|beta|alpha"),
    ("k_t", "k|kappa|c|k_t"), ("gamma", "gamma"), ("I_xx", "I_?(xx|x|11|1)"), ("I_yy", "I_?(yy|y|22|2)"),
    ("I_zz", "I_?(zz|z|33|3)"), ("I_xy", "I_?(xy|12)"), ("I_xz", "I_?(xz|13|zx)"), ("I_yz", "I_?(yz|23)"),
    ("q([0-3])", r"q_?[0-3]"), ("rho", "rho"), ("e", "e"),
)  # fmt: skip
"""Pairs of patterns: one for symbols of derived formulas, and one for the letters that books use for these symbols."""


@dataclass(frozen=True)
class Meant:
    """A known formula whose name fits a claim in its context, written in the claim's letters.

    Attributes
    ----------
    known : Known
    value : Expr or Matrix
        The formula in the claim's letters.
    mapping : dict
        The claim's letter for each symbol that is renamed.
    open_place : bool
        Whether the claim leaves open through which point of the body the axis goes.
    how : str
        The form in which the formula is meant, such as "transposed"; empty for the formula as it is.
    """

    known: Known
    value: Any
    mapping: dict[str, str]
    open_place: bool = False
    how: str = ""

    @property
    def identification(self) -> Identification:
        """The formula ``known`` as an Identification, the type of the entries of ``Verdict.recognised_as``."""
        return Identification(self.known.name.removesuffix(SQUARED), self.how, self.mapping, self.known.source)


def meant_by(context: Context, value: Any, quantity: str, stated: str) -> Iterator[Meant]:
    """Yield the known formulas whose names fit a claim about ``quantity``, in the letters of the claim's formula
    ``value``.

    ``stated`` are words that the quantity's name implies, such as "first component" for omega_1. A formula is yielded
    once for each assignment of the letters.
    """
    shape = value.shape if is_matrix(value) else None
    own = atoms_of(list(value) if shape else [value]) - {time}
    for known in all_known():
        if known.is_step or known.is_relation or not admits_name(context, known.name, quantity):
            continue
        open_words = guesses(context, known.name, stated)
        is_stated = context.meaning_of(quantity) is not None or any(word in known.name for word in stated.split())
        if not is_stated or not all(map(is_place, open_words)):
            continue
        target = known_value(known.text)
        target = _root(target) if known.name.endswith(SQUARED) else target
        if getattr(target, "shape", None) != shape or not is_component(known.name, quantity):
            continue
        target = with_letters(context, target)
        is_specific = bool(bodies_of_formula(known.name)) or bool(context.sequence and context.sequence in known.name)
        for mapping in islice(assignments_of(context, target, own, quantity, known, is_specific), MOST_ASSIGNMENTS):
            renamed = target.xreplace({**_unused_rates(mapping, own), **mapping})
            used = target.free_symbols
            names = {old.name: as_text(new) for old, new in mapping.items() if old in used}
            names = {old: new for old, new in names.items() if plain(new) != old}
            yield Meant(known, renamed, names, bool(open_words))


def _root(square: Expr) -> Expr:
    """Return the square root of ``square``, whose symbols count as positive, as masses are: a for a^2."""
    positive = {symbol: Dummy(positive=True) for symbol in square.free_symbols}
    return sqrt(square.xreplace(positive)).xreplace({new: old for old, new in positive.items()})


def _unused_rates(mapping: Mapping[Expr, Expr], own: set[Expr]) -> dict[Expr, Expr]:
    """Return a map from angle rates of a known formula to derivatives in a claim: ``{dphi: diff(phi(t), t)}``.

    ``mapping`` maps symbols of the known formula to letters of the claim. The returned map has only the rates that
    ``mapping`` does not contain. It is empty if ``own``, the symbols and derivatives of the claim, has no derivative.
    """
    if not any(atom.is_Derivative for atom in own):
        return {}
    # a claim that writes derivatives has no letter for dphi
    functions = {symbol: Function(symbol.name[1:], real=True)(time) for symbol in ANGLES if symbol.name.startswith("d")}
    return {symbol: value.diff(time) for symbol, value in functions.items() if symbol not in mapping}


def all_known() -> Iterator[Known]:
    for formulas in by_fingerprint().values():
        yield from formulas


def with_letters(context: Context, target: Any) -> Any:
    """Return the known formula ``target`` with the body's letters: r for R if the context says "disk of radius r"."""
    if context.body is None:
        return target
    letters = dict(context.body.letters)
    if context.body.kind.title == "cube" and not letters:
        letters = {"b": "a", "c": "a"}
    own = {symbol.name: symbol for symbol in target.free_symbols}
    factors = {name: Rational(factor.numerator, factor.denominator) for name, factor in context.body.factors.items()}
    return target.xreplace({
        own[name]: factors.get(name, 1) * Symbol(letter, real=True) for name, letter in letters.items() if name in own
    })  # fmt: skip


def assignments_of(
    context: Context, target: Any, own: set[Expr], quantity: str, known: Known, is_specific: bool
) -> Iterator[dict[Expr, Expr]]:
    """Yield maps from symbols of the known formula ``target`` to the letters ``own`` of a claim: {R: r} for a radius.

    A symbol is mapped only to a letter that books use for it, or to a letter with this meaning in the context. The axes
    in the letters, such as x in I_x, must agree with the axis in ``quantity``, the name for which the claim gives a
    formula. Every letter of the claim is used. Symbols of the formula may be left over only if ``is_specific``: if the
    formula is for one body or one sequence of angles.
    """
    own_symbols = sorted(target.free_symbols - {time}, key=str)
    if context.sequence and context.sequence in known.name:  # a formula may lack an angle that the claim has
        own_symbols = sorted({*own_symbols, *ANGLES}, key=str)
    pinned = set(context.body.letters.values()) if context.body else set()
    names = {symbol.name for symbol in own_symbols}
    atoms = [atom for atom in sorted(own, key=str) if plain(as_text(atom)) not in pinned - names]
    if len(atoms) > len(own_symbols) or (len(atoms) < len(own_symbols) and not is_specific):
        return
    choices = []
    for atom in atoms:
        name = plain(as_text(atom))
        fitting = [symbol for symbol in own_symbols if _may_be(context, name, symbol.name, pinned)]
        exact = [symbol for symbol in fitting if symbol.name == name]
        is_open = name in ("phi", "psi", "dphi", "dpsi") and not has_order(context.sequence)
        is_open = is_open or (re.fullmatch(SIDES, name) is not None and not pinned)
        choices.append(
            [*exact, *(symbol for symbol in fitting if symbol not in exact)] if is_open else exact or fitting
        )
    for chosen in islice(_distinct(choices), MOST_CHOICES):
        pairs = [(symbol.name, as_text(atom)) for symbol, atom in zip(chosen, atoms, strict=True)]
        free = [pair for pair in pairs if pair[0] not in pinned]
        if not is_consistent([*free, *component(known.name, quantity)], known.has_fixed_axes):
            continue
        letters = [as_text(atom) for atom in atoms]
        unpinned = {old: new for old, new in free if old != new}
        if admits_letters(replace(context, body=None), known.name, unpinned, letters):
            yield dict(zip(chosen, atoms, strict=True))


def _may_be(context: Context, name: str, symbol: str, pinned: set[str]) -> bool:
    """Return whether ``name``, a letter of a claim, can stand for ``symbol`` in a known formula: r for R.

    ``pinned`` are the letters that the context gives to dimensions of the body: such a letter stands only for itself.
    """
    if symbol in pinned or name in pinned:
        # a letter that the context gives to a dimension of the body stands for that symbol alone
        return name == symbol
    meaning = context.meaning_of(name)
    if len(axes_of(symbol)) > 1 and axes_of(symbol) != axes_of(name):
        return False  # an entry of a matrix keeps its row and column, or exchanges them
    if meaning is not None and meaning.quantity.symbols:
        return re.fullmatch(meaning.quantity.symbols, symbol) is not None
    return name == symbol or any(
        re.fullmatch(pattern, symbol) and re.fullmatch(letters, name) for pattern, letters in USUAL
    )


def _distinct(choices: Sequence[Sequence[Expr]]) -> Iterator[tuple[Expr, ...]]:
    """Yield the tuples that take one member from each list in ``choices``, and no member twice."""
    if not choices:
        yield ()
        return
    for first in choices[0]:
        rest = [[symbol for symbol in choice if symbol != first] for choice in choices[1:]]
        for others in _distinct(rest):
            yield (first, *others)
