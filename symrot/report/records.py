"""Types of the JSON records that commands print with ``--json`` and write into files.

Only type checkers import this module, so that no command waits for it.
"""

from typing import Any, NotRequired, TypedDict

__all__ = [
    "ArrayRecord", "BodyRecord", "CostRecord", "DerivativeRecord", "FileRecord", "FinalRecord", "LostRecord",
    "OperationsRecord", "PlanReport", "PlanRow", "RunReport", "SwitchingRecord", "WrittenRecord",
]  # fmt: skip


# --- symrot run -------------------------------------------------------------------------------------------------------


class SceneRecord(TypedDict):
    """The scene of a run: its name, and the path of its file if it has one."""

    name: str
    title: str
    source: str
    path: str | None


BodyRecord = TypedDict(
    "BodyRecord",
    {
        "description": str,
        "class": str,
        "principal_moments": list[str],
        "axes_are_principal": bool,
        "about": str,
        "mass": str | None,
    },
)
"""A body: its principal moments of inertia (kg m^2) and its mass (kg) as exact text, and other properties."""


class InitialRecord(TypedDict):
    """The initial state of a run: angular velocity ``omega`` (rad/s) as exact text, and the quaternion."""

    omega: list[str]
    quaternion: list[float]


class SpanRecord(TypedDict):
    """The time span of a run: first and last time (s) as exact text, and the number of samples."""

    start: str
    stop: str
    samples: int


class MethodRecord(TypedDict):
    """The integration method of a run, the reason for it, and its tolerance."""

    name: str
    reason: str
    tolerance: float


class RuleRecord(TypedDict):
    """The decision of one rule of a plan, a simplification of the equations of motion such as using a symmetry.

    See :class:`symrot.planning.rules.RuleOutcome`.
    """

    item: str
    skipped: bool
    why: str
    derivation: str


class CostRecord(TypedDict):
    """What a motion cost: steps, evaluations of the equations of motion, and seconds.

    ``rejected`` counts the steps that were tried again; ``preparation_seconds`` is the time until the kernel was ready.
    """

    steps: int
    rejected: int
    evaluations: int
    seconds: float
    preparation_seconds: float


class SwitchingRecord(TypedDict):
    """One time ``t`` at which a function with a jump or kink in a torque, such as sign(x), switches.

    See :class:`symrot.propagation.steppers.stats.Switching`.
    """

    t: float
    function: str
    how: str


class InvariantRecord(TypedDict):
    """A quantity that the motion conserves, and how far its computed value drifts.

    See :class:`symrot.propagation.trajectory.Invariant`.
    """

    name: str
    unit: str
    initial: float
    scale: float
    drift: float
    reason: str


class LostRecord(TypedDict):
    """A quantity, such as a momentum component, that many motions conserve but this one does not, with the reason."""

    name: str
    unit: str
    reason: str


class DerivativeRecord(TypedDict):
    """The derivatives of the last sample with respect to one variable, an initial value or a constant."""

    # derivative of the angular velocity, rad/s per unit; None at a switch of a torque, where the derivative jumps
    omega: list[float] | None
    # derivative of the attitude: its product with a small change of the variable is the rotation vector, rad, in body
    # axes, by which the attitude changes
    rotation: list[float] | None
    # unit of the variable
    unit: str


class FinalRecord(TypedDict):
    """The last sample of a motion: ``t`` (s) and ``omega`` (rad/s), and the quaternion if it was computed.

    ``sensitivities``, if requested, has the derivatives of this sample with respect to each variable, by its name.
    """

    t: float
    omega: list[float]
    quaternion: NotRequired[list[float]]
    sensitivities: NotRequired[dict[str, DerivativeRecord]]


class WrittenRecord(TypedDict):
    """A file that a run wrote; for a file of samples, also the number of samples and the names of the arrays."""

    file: str
    samples: NotRequired[int]
    arrays: NotRequired[list[str]]


class RunReport(TypedDict):
    """The complete report of `symrot run`, as ``symrot run --json`` prints it."""

    symrot: str
    scene: SceneRecord
    body: BodyRecord
    torques: list[str]
    initial: InitialRecord
    span: SpanRecord
    method: MethodRecord
    states: list[str]
    plan: list[RuleRecord]
    cost: CostRecord
    switching_times: list[float]
    switchings: list[SwitchingRecord]
    warnings: list[str]
    invariants: list[InvariantRecord]
    not_conserved: list[LostRecord]
    final: FinalRecord
    written: dict[str, WrittenRecord]


# --- symrot explain ---------------------------------------------------------------------------------------------------


class PlanRow(TypedDict):
    """A row of the table of `symrot explain`: what is computed or skipped, and how many operations that saves.

    A row may be about a rule that shortens the equations of motion, such as using a symmetry of the body. Then
    ``operations`` has the numbers of multiplications, additions, .. that remain in the equations after this rule and
    the rules of the rows above it, and ``saved`` is the number of operations that the rule saves. In other rows, both
    are None.
    """

    item: str
    skipped: bool
    why: str
    derivation: str
    operations: dict[str, int] | None
    saved: int | None


class OperationsRecord(TypedDict):
    """Numbers of operations in one evaluation of the rates ``dy/dt``.

    ``general`` is for the equations of any body, ``specialised`` for the equations that the plan has simplified.
    """

    general: int
    specialised: int


class NamedScene(TypedDict):
    """The scene to which the report of `symrot explain` belongs: name, title and source."""

    name: str
    title: str
    source: str


class PlanReport(TypedDict):
    """The complete report of `symrot explain`, as ``symrot explain --json`` prints it."""

    scene: NamedScene
    rows: list[PlanRow]
    operations: OperationsRecord


# --- files of samples -------------------------------------------------------------------------------------------------


class ArrayRecord(TypedDict):
    """The description of one array in a file of samples: components, unit, frame and meaning."""

    components: list[str]
    unit: str
    frame: str
    meaning: str


class DriftRecord(TypedDict):
    """How far one conserved quantity drifts over a motion, as recorded in a file of samples."""

    name: str
    unit: str
    drift: float
    reason: str


class EventRecord(TypedDict):
    """The times, s, of one event in a file of samples, and whether it is rising, falling or touching at each time."""

    formula: str
    kinds: list[str]
    times: list[float]


class FileRecord(TypedDict):
    """The description at the head of a file of samples; it says what each array is and how the motion was computed."""

    symrot: str
    scene: str
    title: str
    source: str
    method: str
    tolerance: float
    status: int
    message: str
    warnings: list[str]
    steps: int
    evaluations: int
    moments_of_inertia: list[str]
    arrays: dict[str, ArrayRecord]
    invariants: list[DriftRecord]
    events: list[EventRecord]
    conventions: str
    sensitivities: NotRequired[dict[str, Any]]
