"""Claims that mix rates of Euler angles with components of the angular velocity: ``psi' = omega_3 - phi' cos theta``.

Each follows from ``omega = B(q) dq/dt`` or contradicts it. With the components replaced by their formulas in the
independent angles and rates, a true claim is an identity.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import product

from sympy import Expr, Matrix, Symbol

from symrot.checker.claim.interpreter import atoms_of, time
from symrot.checker.context.admission import is_usual_for_body, plain
from symrot.checker.context.angle_orders import USUAL_SEQUENCES, are_roll_pitch_yaw, letter_of_angle, orders
from symrot.checker.context.context import Context
from symrot.checker.context.relations.substitution import Substitution
from symrot.conventions import SEQUENCES
from symrot.exact.printing import as_text
from symrot.kinematics.euler import dcm, rate_jacobian

__all__ = ["substitutions_of_entries", "substitutions_of_rates"]

FRAMES = ("body", "space")
COMPONENT = re.compile(r"(?:omega|w|Omega)_?([1-3xyz])(?:_prime)?|([pqr])")
"""Pattern of the name of a component of the angular velocity. Group 1 is the index, as in omega_3; group 2 is p, q or
r, the letters of the components for an aircraft."""

AXES = {letter: axis for axis, letters in enumerate(("1xp", "2yq", "3zr")) for letter in letters}


def substitutions_of_rates(context: Context, sides: Sequence[Expr]) -> Iterator[Substitution]:
    """Yield each Substitution for a claim with Euler rates: omega_3 becomes ``phi' cos(theta) + psi'``."""
    names = {atom: _plain(atom) for atom in sorted(atoms_of(sides) - {time}, key=str)}
    components = {atom: match for atom, name in names.items() if (match := COMPONENT.fullmatch(name))}
    others = {atom: name for atom, name in names.items() if atom not in components}
    rates = {atom: name[1:] for atom, name in others.items() if name[:1] == "d" and letter_of_angle(name[1:])}
    angles = {atom: name for atom, name in others.items() if atom not in rates}
    letters = list(dict.fromkeys([*rates.values(), *angles.values()]))
    if not components or not rates or not all(map(letter_of_angle, letters)):
        # a letter of another kind, no rate, or no component
        return
    is_of_aircraft = not context.sequence and any(match[2] for match in components.values())
    frames = _frames(context, names, components)
    sequences = [context.sequence] if context.sequence else dict.fromkeys((*USUAL_SEQUENCES, *SEQUENCES))
    # each fixes the sequence, the frame, and the angle of each letter, as far as the context leaves them open
    for sequence, frame in product([name for name in sequences if is_usual_for_body(context, name)], frames):
        for order in orders(context, letters, sequence):
            if is_of_aircraft and not are_roll_pitch_yaw(sequence, order.places):
                continue
            q, dq = _coordinates(order.places)
            rates_matrix = rate_jacobian(sequence, frame)
            omega = Matrix(rates_matrix.xreplace(dict(zip(rates_matrix.parameters, q, strict=True)))) * Matrix(dq)
            values = {atom: q[order.places[name]] for atom, name in angles.items()}
            values |= {atom: dq[order.places[name]] for atom, name in rates.items()}
            values |= {atom: omega[AXES[match[1] or match[2]]] for atom, match in components.items()}
            open_words = [] if context.sequence else [sequence]
            open_words += [] if len(frames) == 1 else [f"in the {frame} frame"]
            guess = ", ".join(filter(None, [" ".join(open_words), order.guess]))
            name = f"angular velocity of {sequence} in the {frame} frame, by the rates of the angles"
            source = f'symrot.rate_jacobian("{sequence}", "{frame}")'
            yield Substitution(name, source, values, guess)


def _plain(atom: Expr) -> str:
    """Return the name of a symbol or rate of a claim: phi for ``phi(t)``, dphi for ``diff(phi(t), t)`` and phi_dot."""
    name = plain(as_text(atom))
    return f"d{name.removesuffix('_dot')}" if name.endswith("_dot") else name


def _frames(context: Context, names: dict[Expr, str], components: dict[Expr, re.Match[str]]) -> tuple[str, ...]:
    """Return the frames in which a claim may have components of the angular velocity: the stated frames, or both.

    Without a statement, p, q and r are components in the body frame.
    """
    stated = {meaning.frame for atom in components if (meaning := context.meaning_of(names[atom])) and meaning.frame}
    stated |= {context.frame} if context.frame else set()
    if not stated and any(match[2] for match in components.values()):
        return ("body",)  # p, q and r are rates about the axes of an aircraft
    return FRAMES if not stated else tuple(sorted(stated))


def _coordinates(places: dict[str, int]) -> tuple[list[Symbol], list[Symbol]]:
    """Return symbols for the three angles of a sequence and for their rates, with the claim's letters as names.

    ``places`` maps each letter of the claim to the position of its angle in the sequence, 0, 1 or 2. An angle without a
    letter gets a name such as q_1.
    """
    names = {place: name for name, place in places.items()}
    # angles without a letter in the claim
    unused = iter(name for name in ("q_1", "q_2", "q_3") if name not in places)
    letters = [names.get(place) or next(unused) for place in range(3)]
    return [Symbol(name, real=True) for name in letters], [Symbol(f"d{name}", real=True) for name in letters]


ENTRY = re.compile(r"[RACQT]_?([1-3])_?([1-3])")
"""Pattern of the name of an entry of a rotation matrix, such as R_31; groups 1 and 2 are row and column."""


def substitutions_of_entries(context: Context, sides: Sequence[Expr]) -> Iterator[Substitution]:
    """Yield each Substitution for a claim such as ``R_31 = ..``: R_31 becomes its formula by the stated Euler
    sequence.
    """
    names = {atom: plain(as_text(atom)) for atom in sorted(atoms_of(sides) - {time}, key=str)}
    entries = {atom: match for atom, name in names.items() if (match := ENTRY.fullmatch(name))}
    angles = {atom: name for atom, name in names.items() if atom not in entries}
    letters = list(dict.fromkeys(angles.values()))
    if not context.sequence or len(entries) != 1 or not letters or not all(map(letter_of_angle, letters)):
        return
    ((atom, match),) = entries.items()
    row, column = (int(digit) - 1 for digit in match.groups())
    for order in orders(context, letters, context.sequence):
        q, _ = _coordinates(order.places)
        matrix = dcm(context.sequence, q)
        # the claim does not say whether the matrix takes body components to space components, or is the transpose
        for words, value in (("body to space", matrix[row, column]), ("space to body", matrix[column, row])):
            name = f"entry {row + 1}{column + 1} of the rotation matrix of {context.sequence}, {words}"
            guess = ", ".join(filter(None, [words, order.guess]))
            values = {angle: q[order.places[letter]] for angle, letter in angles.items()}
            yield Substitution(name, f'symrot.dcm("{context.sequence}")', {**values, atom: value}, guess)
