"""The structure of a motion: which constants are zero, equal or free (any value). It determines the equations.

Scenes of the same structure share one kernel (the code of the equations) and differ in the values of its parameters.
The parts are NamedTuples, since a dataclass takes six times as long at every start.
"""

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from enum import Enum
from typing import Any, NamedTuple

__all__ = [
    "MOVING", "FieldPattern", "FieldTorque", "FormulaTorque", "InertiaTensor", "Pattern", "PrincipalInertia",
    "Structure", "TorqueStructure", "TorqueSwitch", "component_names",
]  # fmt: skip


class Pattern(Enum):
    """What the equations assume about a constant: that it is 0, 1 or -1, or nothing (free)."""

    # these disappear from the formulas, which makes them shorter
    ZERO = "0"
    ONE = "1"
    MINUS_ONE = "-1"
    FREE = "*"  # the constant stays a symbol

    __hash__ = object.__hash__  # members are equal if identical; the hash of Enum is a slower call in Python


FieldPattern = Pattern | tuple[Pattern, ...]
"""What the equations assume about a field of a torque, an entry such as ``weight`` or ``direction`` of the scene file.

It is one :class:`Pattern` for a number, a tuple of three for a vector, and of four for a quaternion.
"""


def component_names(name: str, pattern: FieldPattern) -> list[str]:
    """Return the names of the symbols for a field of a torque, such as ``weight`` or ``direction``.

    A number ``c`` has the symbol ``c``, a vector ``c_1`` to ``c_3``, a quaternion ``c_0`` to ``c_3``. ``pattern`` shows
    which of the three the field is: it has one :class:`Pattern` (0, 1, -1 or free), three or four.
    """
    if isinstance(pattern, Pattern):
        return [name]
    return [f"{name}_{index}" for index, _ in enumerate(pattern, start=0 if len(pattern) == 4 else 1)]


class PrincipalInertia(NamedTuple):
    """Principal moments about the body axes 1, 2, 3 as letters; ``"AAC"`` means equal moments about axes 1 and 2."""

    moments: str = "ABC"


class InertiaTensor(NamedTuple):
    """An inertia tensor with products of inertia: the sorted names of its entries that are not zero.

    Example: ``("I_xx", "I_xy", "I_yy", "I_zz")``.
    """

    entries: tuple[str, ...]


class TorqueSwitch(NamedTuple):
    """A function in a torque's formulas that jumps (such as sign) or has a kink (such as abs)."""

    # fields as in :class:`symrot.formula.switches.Switch`, formulas as texts
    mode: str
    kind: str
    guard: str
    where: tuple[tuple[str, int], ...]
    label: str
    at_zero: int
    choices: str = ""  # the guard with its calls ``where(condition, u, v)``, see FormulaTorque; empty without calls


class FieldTorque(NamedTuple):
    """The structure of a torque whose fields are numbers and vectors; this is every kind except ``expression``.

    A field is an entry of the torque in the scene file, such as ``weight`` or ``direction``.

    Attributes
    ----------
    kind : str
        A key of :data:`symrot.dynamics.torque_kinds.TORQUE_KINDS`.
    prefix : str
        Text before the names of its constants, so that they differ from the names in other torques.
    fields : pairs of name and pattern
        The fields of the torque, in the order of the table of torques. The pattern says whether a number is 0, 1, -1
        or free (:class:`Pattern`); for a vector it is a tuple with one pattern for each component.
    """

    kind: str
    prefix: str
    fields: tuple[tuple[str, FieldPattern], ...]

    def number(self, name: str) -> Pattern:
        """Return what is known of a scalar field such as ``"weight"``: that it is 0, 1 or -1, or nothing (free)."""
        pattern = dict(self.fields)[name]
        assert isinstance(pattern, Pattern)
        return pattern

    def vector(self, name: str) -> tuple[Pattern, ...]:
        """Return the patterns (0, 1, -1 or free) of the components of the field ``name``, a vector or a quaternion."""
        pattern = dict(self.fields)[name]
        assert isinstance(pattern, tuple)
        return pattern


class FormulaTorque(NamedTuple):
    """A torque given by formulas, the kind ``expression``.

    Attributes
    ----------
    prefix : str
        Text before the names of its parameters, so that they differ from the names in other torques.
    formulas : tuple of 3 str
        The components of the torque. Functions that switch, such as sign, are replaced by modes: constants that have
        the present values of the functions. A call ``where(condition, u, v)`` is replaced by v + p*(u - v), where p is
        1 if the condition holds, else 0; this sum needs the values of both branches.
    parameters : tuple of str
        Names of the parameters and modes in the formulas.
    frame : str
        ``"body"`` or ``"space"``: the frame of the components.
    switches : tuple of TorqueSwitch
        The jumps and kinks of the formulas; empty if the formulas are smooth, or if the plan was made without modes.
    choices : tuple of str
        The formulas in which calls ``where(condition, u, v)`` are not replaced by sums, because a branch such as
        ``1/omega_1`` may only be evaluated where it applies. The equations are made from these formulas, with the
        branch that applies in place of each call. Empty if both branches of all calls may always be evaluated.
    held : tuple of str
        Modes whose guards (arguments of the functions) stay at zero while the motion slides.
    """

    prefix: str
    formulas: tuple[str, ...]
    parameters: tuple[str, ...]
    frame: str
    switches: tuple[TorqueSwitch, ...] = ()
    choices: tuple[str, ...] = ()
    held: tuple[str, ...] = ()

    @property
    def kind(self) -> str:
        """The kind of the torque, always ``"expression"``; :class:`FieldTorque` has an attribute of this name too."""
        return "expression"

    @property
    def has_choices(self) -> bool:
        """Whether a formula has a branch that cannot be evaluated everywhere, as in ``where(omega_1 > 0, 1/omega_1,
        0)``.
        """
        return bool(self.choices) or any(switch.choices for switch in self.switches)


TorqueStructure = FieldTorque | FormulaTorque

MOVING = (None, None, None)
"""Value of :attr:`Structure.constant` if no component of omega is constant."""


@dataclass(frozen=True, slots=True)
class Structure:
    """The facts that determine the equations of a motion: which constants are zero, equal or free.

    Attributes
    ----------
    inertia : PrincipalInertia or InertiaTensor
        The moments that are equal, or the entries that are not zero.
    torques : tuple of FieldTorque and FormulaTorque
        The torques, in the order of the scene.
    attitude : bool
        Whether the attitude is computed.
    planar : int, optional
        The index, 0 to 2, of the body axis, if the body rotates only about one axis.
    initial_quaternion : tuple of 4 Pattern, optional
        The components of the initial quaternion in such a rotation about one axis, whose state is the angle since the
        start; None if the attitude is not computed.
    constant : tuple of 3
        For each component of omega_b: its pattern (zero or free) if it is constant, None if it changes.
    clock : str, optional
        The name of the constant from which the rates count time (the epoch); None if they count from t = 0 of the
        scene.
    sequence : str, optional
        The Euler sequence whose angles are the state; None if the state is a quaternion.

    Examples
    --------
    >>> import symrot
    >>> symrot.plan("tumbling_prism").structure.moving
    [0, 1, 2]
    """

    inertia: PrincipalInertia | InertiaTensor
    torques: tuple[TorqueStructure, ...]
    attitude: bool = True
    planar: int | None = None
    initial_quaternion: tuple[Pattern, ...] | None = None
    constant: tuple[Pattern | None, Pattern | None, Pattern | None] = MOVING
    clock: str | None = None
    sequence: str | None = None

    @property
    def formula_torques(self) -> Iterator[FormulaTorque]:
        """The torques that are given by formulas, in the order of the scene."""
        return (torque for torque in self.torques if isinstance(torque, FormulaTorque))

    @property
    def moving(self) -> list[int]:
        """The indices, 0 to 2, of the components of omega_b that change and are therefore states."""
        return [i for i in range(3) if self.constant[i] is None and self.planar in (None, i)]

    @property
    def reductions(self) -> tuple[object, ...]:
        """The attributes ``planar``, ``initial_quaternion`` and ``constant``, which say which states are eliminated.

        Two structures have the same states if their reductions are equal, and also their ``attitude`` and their
        ``sequence``.
        """
        return self.planar, self.initial_quaternion, self.constant

    def unreduced(self) -> "Structure":
        """Return the structure in which no state is eliminated and nothing is assumed about the initial state.

        All components of omega_b are states, and all components of q if the attitude is computed.
        """
        return replace(self, planar=None, initial_quaternion=None, constant=MOVING)

    def to_json(self) -> dict[str, object]:
        """Return the structure as data for JSON; structures are equal if and only if their data are equal."""
        # The cache finds the compiled kernel of a plan by these data.
        return {field.name: _plain(getattr(self, field.name)) for field in fields(self)}


def _plain(value: Any) -> Any:
    if isinstance(value, Pattern):
        return value.value
    if hasattr(value, "_asdict"):  # a NamedTuple
        return {name: _plain(item) for name, item in value._asdict().items()}
    return [_plain(item) for item in value] if isinstance(value, tuple) else value
