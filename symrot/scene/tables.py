"""The small tables of a scene file (initial state, span, output and accuracy) and the functions that read them.

All numbers are exact. This module does not use SymPy.
"""

from fractions import Fraction
from typing import Any, NamedTuple

from symrot.errors import InputError
from symrot.formula.exact_numbers import read
from symrot.scene.attitude import Attitude, Quaternion, Vector, read_attitude, read_sequence, to_body
from symrot.scene.body import read_body
from symrot.scene.reader import Entry, choice, fail, flag, items, number, read_table, text, unchanged, vector

__all__ = [
    "QUANTITIES",
    "SCHEMA",
    "TOLERANCES",
    "TOP",
    "Initial",
    "Output",
    "Span",
    "read_tolerance",
    "with_other_attitude",
]

SCHEMA = 1
MOST_SAMPLES = 10_000_000
TOLERANCES = (Fraction(1, 10**15), Fraction(1, 100))

QUANTITIES: dict[str, tuple[str, str]] = {
    "omega": ("rad/s", "angular velocity, body components"),
    "omega_space": ("rad/s", "angular velocity, space components"),
    "quaternion": ("1", "attitude (q0, q1, q2, q3), scalar first, body to space"),
    "euler": ("rad", "Euler angles of the given sequence"),
    "dcm": ("1", "direction cosine matrix dcm_sb, row by row"),
    "energy": ("J", "energy: kinetic, and potential where the torques have one"),
    "kinetic_energy": ("J", "kinetic energy"),
    "angular_momentum_body": ("kg m^2/s", "angular momentum, body components"),
    "angular_momentum_space": ("kg m^2/s", "angular momentum, space components"),
    "polhode": ("rad/s", "path of the angular velocity in the body; without torques, on the energy ellipsoid"),
    "herpolhode": ("rad/s", "path of the angular velocity in space; without torques, on the invariable plane"),
    "axis": ("1", "symmetry axis of the body (its third axis when it has none), space components"),
}
"""Output quantities that a scene may request: name -> (unit, meaning)."""


class Initial(NamedTuple):
    """Initial state of a motion: angular velocity and attitude, as exact fractions.

    Attributes
    ----------
    omega_b : tuple of 3 Fraction
        Angular velocity, body components, rad/s.
    quaternion : tuple of 4 Fraction
        Attitude, scalar first, body to space; its norm differs from 1 by at most 2^-200.
    omega_s : tuple of 3 Fraction or None
        Angular velocity, space components, rad/s, if the scene gives these; None if it gives body components.

    Examples
    --------
    >>> import symrot
    >>> scene = symrot.load_scene("tumbling_prism")
    >>> scene.initial.quaternion[0]
    Fraction(1, 1)
    """

    omega_b: Vector
    quaternion: Quaternion
    omega_s: Vector | None = None


def with_other_attitude(initial: Initial, attitude: Attitude) -> Initial:
    """Return an initial state with another attitude; the components of omega that the scene gives stay the same."""
    omega_b = initial.omega_b if initial.omega_s is None else to_body(attitude.dcm, initial.omega_s)
    return initial._replace(omega_b=omega_b, quaternion=attitude.quaternion)


class Span(NamedTuple):
    """The sample times of a scene, evenly spaced.

    Attributes
    ----------
    start, stop : Fraction
        First and last time, s.
    samples : int
        Number of times, including the first and the last one.

    Examples
    --------
    >>> import symrot
    >>> scene = symrot.load_scene("tumbling_prism")
    >>> scene.span.start
    Fraction(0, 1)
    """

    start: Fraction
    stop: Fraction
    samples: int


class Output(NamedTuple):
    """The quantities in the output of a scene, and the sequence and unit of its Euler angles.

    Attributes
    ----------
    quantities : tuple of str
        Names among :data:`symrot.scene.tables.QUANTITIES`.
    sequence : str or None
        Euler sequence of the quantity ``"euler"``.
    degrees : bool
        Whether the Euler angles are in degrees instead of rad.

    Examples
    --------
    >>> import symrot
    >>> scene = symrot.load_scene("tumbling_prism")
    >>> "omega" in scene.output.quantities
    True
    """

    quantities: tuple[str, ...]
    sequence: str | None
    degrees: bool


# --- the readers of each table ----------------------------------------------------------------------------------------


def _schema(value: Any, where: str) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value != SCHEMA:
        fail(where, f"{SCHEMA}, the format this symrot reads", value)
    return SCHEMA


def _read_initial(value: Any, where: str) -> Initial:
    entries = {"omega": Entry(vector("rad/s")), "omega_space": Entry(vector("rad/s")), "attitude": Entry(read_attitude)}
    values = read_table(value, where, entries, "the initial state")
    present = [key for key in ("omega", "omega_space") if values[key] is not None]
    if len(present) != 1:
        expectation = "exactly one of omega (body axes) and omega_space, three numbers in rad/s"
        if not present:
            fail(f"{where}.omega", f"{expectation}, got neither")
        fail(f"{where}.omega", expectation, {key: value[key] for key in present})
    attitude = values["attitude"] or read_attitude({"quaternion": [1, 0, 0, 0]}, where)
    omega_b = values["omega"] if present == ["omega"] else to_body(attitude.dcm, values["omega_space"])
    return Initial(omega_b, attitude.quaternion, values["omega_space"])


def _samples(value: Any, where: str) -> int:
    expectation = f"a whole number of samples from 2 to {MOST_SAMPLES}"
    count = number(expectation)(value, where)
    if count.denominator != 1 or not 2 <= count <= MOST_SAMPLES:
        fail(where, expectation, value)
    return int(count)


_two_times = items(2, number("a time in s"), "the first and the last time, [start, stop] in s")


def _times(value: Any, where: str) -> tuple[Fraction, Fraction]:
    start, stop = _two_times(value, where)
    if float(start) == float(stop):
        fail(where, "a span of positive length, [start, stop] in s", value)
    if start > stop:
        fail(where, "start before stop", value, "a scene runs forward; in Python, a propagator takes times in any "
                 "order")  # fmt: skip
    return start, stop


def _read_span(value: Any, where: str) -> Span:
    entries = {"t": Entry(_times, required=True), "samples": Entry(_samples, default=1001)}
    values = read_table(value, where, entries, "a span")
    start, stop = values["t"]
    return Span(start, stop, values["samples"])


_quantity = choice(*QUANTITIES)


def _quantities(value: Any, where: str) -> tuple[str, ...]:
    if not isinstance(value, list | tuple) or not value:
        fail(where, f"a list of quantities among {', '.join(QUANTITIES)}", value)
    names = tuple(_quantity(item, f"{where}[{index}]") for index, item in enumerate(value))
    for index, name in enumerate(names):
        if name in names[:index]:
            fail(f"{where}[{index}]", "each quantity once", name)
    return names


def _read_output(value: Any, where: str) -> Output:
    values = read_table(value, where, {
        "quantities": Entry(_quantities, default=("omega", "quaternion")),
        "sequence": Entry(read_sequence),
        "degrees": Entry(flag, default=False),
    }, "the output")  # fmt: skip
    if "euler" in values["quantities"] and values["sequence"] is None:
        fail(f"{where}.sequence", 'an Euler sequence for the quantity euler, such as "ZXZ"; the key is missing')
    for key in ("sequence", "degrees"):
        if "euler" not in values["quantities"] and key in value:
            fail(f"{where}.{key}", '"euler" in output.quantities, since no other quantity uses this key', value[key])
    return Output(values["quantities"], values["sequence"], values["degrees"])


def read_tolerance(tolerance: float) -> float:
    """Return the tolerance of a propagation, given as a number or text, as a float.

    Raises
    ------
    InputError
        If it is not a number in the range :data:`TOLERANCES`.
    """
    low, high = map(float, TOLERANCES)
    value = float(read(tolerance, "tolerance"))
    if not low <= value <= high:  # as doubles: the double 0.01 is above 1/100
        raise InputError(f"tolerance: expected a number from {low:g} to {high:g}, got {tolerance}")
    return value


def _read_tolerance(value: Any, where: str) -> Fraction:
    tolerance: Fraction = number("a tolerance")(value, where)
    smallest, largest = TOLERANCES
    if not smallest <= tolerance <= largest:
        reason = "it is a relative error" if tolerance <= 0 else "a double carries no more digits"
        reason = "larger errors make a motion meaningless" if tolerance > largest else reason
        fail(where, "a tolerance from 1e-15 to 1e-2", value, reason)
    return tolerance


def _read_accuracy(value: Any, where: str) -> Fraction:
    values = read_table(value, where, {"tolerance": Entry(_read_tolerance, required=True)}, "the accuracy")
    tolerance: Fraction = values["tolerance"]
    return tolerance


TOP: dict[str, Entry] = {
    "schema": Entry(_schema, required=True),
    "title": Entry(text, default=""),
    "source": Entry(text, default=""),
    "body": Entry(read_body, required=True),
    "initial": Entry(_read_initial, required=True),
    "torque": Entry(unchanged, default=()),
    "span": Entry(_read_span, required=True),
    "output": Entry(_read_output, default=Output(("omega", "quaternion"), None, False)),
    "accuracy": Entry(_read_accuracy, default=Fraction(1, 10**12)),
}
"""The tables and keys of a scene file; torques are read last, since some of their values may come from the body."""
