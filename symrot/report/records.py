"""The records that commands print with ``--json`` and write into files: their keys and types.

Only type checkers read this module, so that no command waits for it.
"""

from typing import NotRequired, TypedDict

__all__ = [
    "ArrayRecord", "BodyRecord", "CostRecord", "FileRecord", "FinalRecord", "LostRecord", "OperationsRecord",
    "PlanReport", "PlanRow", "RunReport", "SwitchingRecord", "WrittenRecord",
]  # fmt: skip


# --- symrot run -------------------------------------------------------------------------------------------------------


class SceneRecord(TypedDict):
    """A scene by name, with the path of its file if it has one."""

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
"""A body: principal moments, kg m^2, and mass, kg, as exact text."""


class InitialRecord(TypedDict):
    """An initial state: omega, rad/s, as exact text, and the quaternion."""

    omega: list[str]
    quaternion: list[float]


class SpanRecord(TypedDict):
    """A span of time, s, as exact text, and the number of samples in it."""

    start: str
    stop: str
    samples: int


class MethodRecord(TypedDict):
    """A method, the reason for it, and the error to aim for."""

    name: str
    reason: str
    tolerance: float


class RuleRecord(TypedDict):
    """The decision of one rule of a plan."""

    item: str
    skipped: bool
    why: str
    derivation: str


class CostRecord(TypedDict):
    """The cost of a motion."""

    steps: int
    rejected: int
    evaluations: int
    seconds: float
    preparation_seconds: float


class SwitchingRecord(TypedDict):
    """A switching of a function at a time, s, see :class:`symrot.propagation.steppers.stepping.Switching`."""

    t: float
    function: str
    how: str


class InvariantRecord(TypedDict):
    """A conserved quantity along a trajectory, see :class:`symrot.propagation.trajectory.Invariant`."""

    name: str
    unit: str
    initial: float
    scale: float
    drift: float
    reason: str


class LostRecord(TypedDict):
    """A quantity that is not conserved, and the reason."""

    name: str
    unit: str
    reason: str


class FinalRecord(TypedDict):
    """The last sample: t, s, omega, rad/s, and the quaternion if it was computed."""

    t: float
    omega: list[float]
    quaternion: NotRequired[list[float]]


class WrittenRecord(TypedDict):
    """A file that was written; one with samples has their number and the names of the arrays."""

    file: str
    samples: NotRequired[int]
    arrays: NotRequired[list[str]]


class RunReport(TypedDict):
    """The report of a run."""

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
    """A row of an explained plan; ``operations`` counts by kind after the row, ``saved`` is the change."""

    item: str
    skipped: bool
    why: str
    derivation: str
    operations: dict[str, int] | None
    saved: int | None


class OperationsRecord(TypedDict):
    """Operations of one evaluation of the rates of the general structure and of the plan's."""

    general: int
    specialised: int


class NamedScene(TypedDict):
    """A scene by name."""

    name: str
    title: str
    source: str


class PlanReport(TypedDict):
    """The report of a plan."""

    scene: NamedScene
    rows: list[PlanRow]
    operations: OperationsRecord


# --- files of samples -------------------------------------------------------------------------------------------------


class ArrayRecord(TypedDict):
    """An array of a file: its components, unit, frame and meaning."""

    components: list[str]
    unit: str
    frame: str
    meaning: str


class DriftRecord(TypedDict):
    """The drift of a conserved quantity."""

    name: str
    unit: str
    drift: float
    reason: str


class FileRecord(TypedDict):
    """The description that a file of samples begins with."""

    symrot: str
    scene: str
    title: str
    source: str
    method: str
    tolerance: float
    steps: int
    evaluations: int
    moments_of_inertia: list[str]
    arrays: dict[str, ArrayRecord]
    invariants: list[DriftRecord]
    conventions: str
