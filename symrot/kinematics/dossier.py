"""The singularities of an Euler sequence: where gimbal lock occurs, how the rates grow there, which sequences to use.

Every entry is derived from :func:`symrot.kinematics.euler.rate_jacobian`. A sequence is regular at an attitude where it
is not in gimbal lock. At gimbal lock, no angle rates rotate the body about one axis, the lost axis.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

from sympy import Expr, ImmutableMatrix, Matrix, S, Set, factor_terms

import symrot
from symrot import symbols
from symrot.conventions import SEQUENCES, parse_sequence
from symrot.kinematics.chart import Limit, SingularSet
from symrot.kinematics.euler import EulerRateMatrix, factors, rate_jacobian, sequences_at_lock

__all__ = ["LockedPoint", "SingularityDossier", "singularity_dossier"]


@dataclass(frozen=True)
class LockedPoint:
    """A value of the middle angle at which an Euler sequence is in gimbal lock.

    Attributes
    ----------
    middle : Expr
        The angle, rad.
    silent_rates : ImmutableMatrix, shape (3, 1)
        Angle rates that do not rotate the body (the null vector of B): the first and the third rate cancel each other.
    lost_axis_b : ImmutableMatrix, shape (3, 1)
        The unit direction (body components) about which no angle rates can rotate the body: ``lost^T B = 0``.
    combination : Expr
        The sum or difference of the first and the third angle; the attitude depends on these two only through it.

    Examples
    --------
    >>> import symrot
    >>> symrot.singularity_dossier("ZXZ").locked[0].combination
    phi + psi
    """

    middle: Expr
    silent_rates: ImmutableMatrix
    lost_axis_b: ImmutableMatrix

    @property
    def combination(self) -> Expr:
        """The sum or difference of the first and the third angle; at gimbal lock the attitude depends on it alone."""
        first, _, third = symbols.angles
        return first - third * self.silent_rates[0] / self.silent_rates[2]


@dataclass(frozen=True, repr=False)
class SingularityDossier:
    """The singularities of an Euler sequence: where gimbal lock occurs, the lost axis there, and regular sequences.

    Attributes
    ----------
    sequence : str
        The Euler sequence, such as ``"ZXZ"``.
    jacobian_b, jacobian_s : EulerRateMatrix
        B of ``omega = B dq/dt`` in body and space components.
    locked : tuple of LockedPoint
        The singular points in one period of the middle angle.
    regular_sequences : tuple of str
        Sequences that are regular at every attitude where this sequence locks.
    partly_regular : dict of str to Set
        Sequences that lock at only some of the attitudes at which this sequence locks, each with the set of these
        attitudes. At gimbal lock, the middle angle is fixed and only the sum or difference of phi and psi matters, so
        that one number describes the attitude: phi, rad, with psi = 0, for an intrinsic sequence; psi, rad, with
        phi = 0, for an extrinsic one. The set contains the values of this angle at which the other sequence locks.
    singular_sequences : tuple of str
        Sequences that lock wherever this sequence locks.

    Examples
    --------
    >>> import symrot
    >>> symrot.singularity_dossier("ZYX").sequence
    'ZYX'
    """

    sequence: str
    jacobian_b: EulerRateMatrix
    jacobian_s: EulerRateMatrix
    locked: tuple[LockedPoint, ...]
    regular_sequences: tuple[str, ...]
    partly_regular: dict[str, Set]
    singular_sequences: tuple[str, ...]

    @property
    def determinant(self) -> Expr:
        return self.jacobian_b.determinant

    @property
    def singular_set(self) -> SingularSet:
        return self.jacobian_b.singular_set

    @property
    def condition_number(self) -> Expr:
        return self.jacobian_b.condition_number

    @property
    def limits(self) -> tuple[Limit, ...]:
        """The limits of the inverse body rate matrix at the locked middle angles: which rates grow without bound."""
        return self.jacobian_b.limits

    def text(self) -> str:
        """Return this report on an Euler sequence as text: determinant, rate matrices, gimbal lock, other sequences.

        The same sequence always gives the same bytes.
        """
        kind = "intrinsic" if parse_sequence(self.sequence)[1] else "extrinsic"
        return "\n".join(
            [
                f"Singularities of the {kind} Euler sequence {self.sequence}, angles phi, theta, psi",
                "",
                f"det B             {self.determinant}",
                f"singular          {self.singular_set}",
                f"condition number  {self.condition_number}",
                "",
                "omega_b = B dq/dt, B =",
                *_rows(self.jacobian_b),
                "omega_s = B dq/dt, B =",
                *_rows(self.jacobian_s),
                "dq/dt = B^-1 omega_b, B^-1 =",
                *_rows(self.jacobian_b.inverse),
                *(line for point in self.locked for line in self._locked_text(point)),
                "",
                f"Regular wherever {self.sequence} locks: {_names(self.regular_sequences)}",
                f"Locked wherever {self.sequence} locks:  {_names(self.singular_sequences)}",
                "Locked at some of these attitudes only:",
                *(f"  {values}: {_names(names)}" for values, names in self._partly_text()),
            ]
        )

    __str__ = text

    def __repr__(self) -> str:
        return f"<SingularityDossier of {self.sequence}>"

    def _repr_markdown_(self) -> str:
        return symrot.in_notebook(self)

    def _locked_text(self, point: LockedPoint) -> Iterable[str]:
        middle = self.singular_set.variable
        yield ""
        yield f"At {middle} = {point.middle}"
        yield f"  the attitude depends on {point.combination} alone; lost axis (body) {_row(point.lost_axis_b)}"
        for limit in self.limits:
            if limit.point == point.middle:
                side = "above" if limit.side == "+" else "below"
                yield f"  from {side}, B^-1 tends to"
                yield from _rows(limit.limit, "    ")
        residue = next(limit.residue for limit in self.limits if limit.point == point.middle)
        yield f"  ({middle} - {point.middle}) B^-1 tends to"
        yield from _rows(residue, "    ")

    def _partly_text(self) -> list[tuple[str, list[str]]]:
        left, _, right = factors(self.sequence)
        groups: dict[str, list[str]] = {}
        for name, values in self.partly_regular.items():
            where = f"{SingularSet(S.Zero, left.angle, values)}, {right.angle} = 0"
            groups.setdefault(where, []).append(name)
        return sorted(groups.items())


def _names(names: Iterable[str]) -> str:
    return " ".join(names) or "none"


def _row(matrix: Matrix) -> str:
    return "(" + ", ".join(map(str, matrix)) + ")"


def _rows(matrix: Matrix, indent: str = "  ") -> list[str]:
    texts = [[str(entry) for entry in matrix.row(i)] for i in range(matrix.rows)]
    widths = [max(len(row[j]) for row in texts) for j in range(matrix.cols)]
    return [
        indent + "[" + "  ".join(text.rjust(width) for text, width in zip(row, widths, strict=True)) + "]"
        for row in texts
    ]


def _locked_point(sequence: str, middle: Expr) -> LockedPoint:
    """Return the angle rates that do not rotate the body at gimbal lock, and the lost axis, as a LockedPoint.

    ``middle`` is the value of the middle angle at gimbal lock. No angle rates can rotate the body about the lost axis.
    """
    first, _, third = symbols.angles
    jacobian = rate_jacobian(sequence, "body", (first, middle, third))
    columns = [jacobian.col(i) for i in range(3)]
    lost = columns[1].cross(columns[2]).applyfunc(factor_terms)
    left, turn, right = factors(sequence, (first, middle, third))
    sense = (left.direction.T * turn.rotation * right.direction)[0]
    # The first and the last axis coincide up to sign, b_first = s b_last; the lost axis is perpendicular to the last
    # and the middle axis.
    silent = ImmutableMatrix([1, 0, -sense])
    return LockedPoint(middle, silent, ImmutableMatrix(lost))


@cache
def singularity_dossier(sequence: str) -> SingularityDossier:
    """Return the singularities of an Euler sequence: gimbal lock, the lost axes, and sequences regular there.

    Parameters
    ----------
    sequence : str
        Intrinsic in upper case (``"ZXZ"``), extrinsic in lower case (``"zxz"``).

    Returns
    -------
    SingularityDossier
        Angles in rad; rate matrices in body and in space components. ``print`` shows all its entries.

    Raises
    ------
    InputError
        For an unknown sequence.

    Notes
    -----
    Proof: ``derivations/euler_singularities.md``.

    Examples
    --------
    >>> import symrot
    >>> [point.middle for point in symrot.singularity_dossier("ZXZ").locked]
    [0, pi]
    """
    jacobian = rate_jacobian(sequence)
    meetings = sequences_at_lock(sequence)
    return SingularityDossier(
        sequence=sequence,
        jacobian_b=jacobian,
        jacobian_s=rate_jacobian(sequence, "space"),
        locked=tuple(_locked_point(sequence, point) for point in jacobian.singular_set.points()),
        regular_sequences=jacobian.regular_sequences,
        partly_regular={name: met for name, met in meetings.items() if met not in (S.EmptySet, S.Reals)},
        singular_sequences=tuple(name for name in SEQUENCES if meetings.get(name) == S.Reals),
    )
