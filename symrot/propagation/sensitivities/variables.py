"""The variables of sensitivities: initial values and constants of a scene.

A motion is differentiated with respect to them. The kernel's constants, such as moments of inertia, follow exactly from
a scene's numbers. Their derivatives are difference quotients over a step of 2^-80 of a variable, with errors below
2^-70.
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from symrot.dynamics.torque_kinds import TORQUE_KINDS
from symrot.errors import InputError
from symrot.formula.exact_numbers import read, show
from symrot.scene.changes import path_of
from symrot.scene.scene import Scene

__all__ = [
    "ATTITUDE",
    "STEP",
    "Variable",
    "difference",
    "groups_of",
    "read_variables",
    "require_formulas",
    "slopes",
]

ATTITUDE = "attitude"
MOST_VARIABLES = 100
RATES = ("omega", "omega_1", "omega_2", "omega_3")
TENSOR = ("principal", "I_xx", "I_yy", "I_zz", "I_xy", "I_xz", "I_yz")
NO_VARIABLES = ("t", "samples", "tolerance", "quantities", "sequence", "degrees")
NO_TABLES = ("schema", "title", "source", "span", "output", "accuracy")
STEP = Fraction(1, 1 << 80)
AGREEMENT = Fraction(1, 1 << 60)
FALL = Fraction(9, 10)  # largest ratio of quotients of one and two steps whose limit is zero
BEND = Fraction(21, 10)  # ratio of second differences of two steps and of one: 4 where a number is smooth, 2 at a kink
ROUNDED = Fraction(1, 1 << 150)  # a smaller second difference, in units of the number, may be a rounding error
UNITS = {
    **dict.fromkeys(RATES, "rad/s"),
    **dict.fromkeys(TENSOR, "kg m^2"),
    "mass": "kg",
    "density": "kg/m^3",
    "moment": "N m",
}
ANGLES = ("angle", "angles")
LENGTHS = (
    "at",
    "fixed_point",
    "radius",
    "length",
    "a",
    "b",
    "c",
    "height",
    "width",
    "depth",
    "thickness",
    "inner_radius",
    "outer_radius",
)


@dataclass(frozen=True)
class Variable:
    """One number with respect to which a motion is differentiated: a component of the initial state, or a constant.

    Attributes
    ----------
    key, name, unit : str
        The requested name, such as ``"omega"``; the name of this component, such as ``"omega_2"``; its unit (SI, or
        ``"deg"`` for an angle that the scene gives in degrees), or an empty text if it is not known.
    value : Fraction
        Its present value.
    moved : function
        Takes a change of the variable and returns the changed scene; None for a small rotation of the initial attitude.
    axis : int
        For a rotation of the initial attitude: the body axis, 0 to 2.
    """

    key: str
    name: str
    unit: str
    value: Fraction
    moved: Callable[[Fraction], Scene] | None
    axis: int = 0

    @property
    def step(self) -> Fraction:
        """A small change of the variable, for difference quotients of exact numbers."""
        return abs(self.value) * STEP if self.value else STEP


def require_formulas(scene: Scene) -> None:
    """Raise InputError if a torque of a scene is given by samples, for callers that need formulas."""
    if scene.table is not None:
        raise InputError(
            f"{scene.name}: expected torques with formulas, which sensitivities need, got a torque of kind table"
        )


def read_variables(scene: Scene, keys: Sequence[str]) -> list[Variable]:
    """Return the variables that the keys of a request name.

    Parameters
    ----------
    scene : Scene
        The scene.
    keys : sequence of str
        ``"omega"`` (three components, rad/s), ``"attitude"`` (a small rotation about each body axis, rad), or a key of
        :meth:`symrot.Scene.with_` that names a number or a vector, such as ``"weight"`` or ``"body.mass"``.

    Raises
    ------
    InputError
        If a key names no initial value or constant, or a variable is named twice; if there is no key, or more than 100
        variables.
    """
    if isinstance(keys, str) or not isinstance(keys, Sequence) or not all(isinstance(key, str) for key in keys):
        raise InputError(f'sensitivities: expected a list of names such as ["omega", "weight"], got {show(keys)}')
    if not keys:
        raise InputError('sensitivities: expected at least one name, such as "omega" or "weight", got none')
    variables = [variable for key in keys for variable in _variables(scene, key)]
    names = [variable.name for variable in variables]
    double = next((name for name in names if names.count(name) > 1), None)
    if double is not None:
        raise InputError(f"sensitivities: expected each variable once, got {double} twice")
    if len(names) > MOST_VARIABLES:
        raise InputError(f"sensitivities: expected at most {MOST_VARIABLES} variables, got {len(names)}")
    return variables


def groups_of(variables: Sequence[Variable]) -> dict[str, tuple[int, ...]]:
    """Return the indices of the variables for each requested name: ``{"omega": (0, 1, 2), "weight": (3,)}``."""
    groups: dict[str, tuple[int, ...]] = {}
    for place, variable in enumerate(variables):
        groups[variable.key] = (*groups.get(variable.key, ()), place)
    return groups


def _variables(scene: Scene, key: str) -> Iterator[Variable]:
    if key == ATTITUDE:
        yield from (Variable(key, f"{key}_{i + 1}", "rad", Fraction(0), None, i) for i in range(3))
        return
    if key == "quaternion":
        raise InputError(
            "sensitivities: expected 'attitude', a small rotation about each body axis, got 'quaternion', whose "
            "components cannot change independently"
        )
    if key in NO_VARIABLES or (path_of(key) or ("",))[0] in NO_TABLES:
        raise InputError(f"sensitivities: expected an initial value or a constant of the scene, got {key!r}")
    try:
        value = scene.value(key)
    except InputError as reason:
        raise InputError(f"sensitivities: {reason}") from None
    unit = _unit(scene, key)
    if not isinstance(value, list | tuple):
        number = _number(key, value)
        yield Variable(key, key, unit, number, lambda change: scene.with_({key: number + change}))
        return
    vector = [_number(key, each) for each in value]

    def moved(place: int) -> Callable[[Fraction], Scene]:
        return lambda change: scene.with_(
            {key: [each + change * (number == place) for number, each in enumerate(vector)]}
        )

    for place, number in enumerate(vector):
        yield Variable(key, f"{key}_{place + 1}", unit, number, moved(place))


def _number(key: str, value: Any) -> Fraction:
    try:
        return read(value)
    except InputError:
        raise InputError(f"sensitivities: expected a number or a vector, but {key} is {show(value)}") from None


def _unit(scene: Scene, key: str) -> str:
    """Return the unit of a key of :meth:`symrot.Scene.with_`: ``"kg"`` for ``"body.mass"``; empty if unknown.

    It is the SI unit or, for an angle that the scene gives in degrees, ``"deg"``.
    """
    last = re.sub(r"(\[\d+\])+$", "", key.rpartition(".")[2])
    if last in UNITS:
        return UNITS[last]
    if last in ANGLES:
        try:
            degrees = bool(scene.value(key.rpartition(".")[0] + ".degrees"))
        except InputError:
            degrees = False
        return "deg" if degrees else "rad"
    stem = last.removesuffix("_1").removesuffix("_2").removesuffix("_3")
    for torque in scene.torques:
        kind = TORQUE_KINDS.get(torque.kind)
        for field in kind.fields if kind else ():
            if last == field.name or stem == field.name or last.partition("_")[2] == field.name:
                return field.unit
    return "m" if last in LENGTHS else ""


Numbers = Mapping[str, Fraction]


def difference(scene: Scene, variable: Variable, numbers: Callable[[Scene], Numbers]) -> dict[str, Fraction]:
    """Return the derivatives of exact numbers of a scene with respect to one variable.

    The result is a map from the name of a number to its derivative.

    Numbers that do not depend on the variable are left out. For the mass of a unit sphere and its moments of inertia:
    ``{"I_xx": Fraction(2, 5), ..}``.

    Parameters
    ----------
    scene : Scene
        The scene.
    variable : Variable
        A variable that is not a rotation of the initial attitude.
    numbers : function
        Takes a scene and returns exact numbers by name.

    Raises
    ------
    InputError
        If the scene is valid on neither side of the variable's value, or if a number is not smooth there.
    """
    moved = variable.moved
    assert moved is not None

    def values(change: Fraction) -> Numbers:
        return numbers(moved(change) if change else scene)

    return slopes(values, variable.step, variable.name)


def slopes(values: Callable[[Fraction], Numbers], step: Fraction, name: str) -> dict[str, Fraction]:
    """Return a map from names of numbers to their derivatives with respect to a variable.

    ``values`` is a function that takes a change of the variable: if it returns {"A": (3 + change)^2}, the result is
    {"A": 6}. Numbers that do not depend on the variable are left out.

    Raises
    ------
    InputError
        If a number has a kink or a jump at the variable's present value.
    """
    differences = _Differences(values, step, name)
    result = {}
    for each, center in differences.at(0).items():
        if all(differences.at(place)[each] == center for place in differences.near):
            continue
        slope = differences.slope(each)
        if slope is None:
            raise InputError(
                f"sensitivities: expected a value of {name} at which the equations of motion have a derivative, but "
                f"their constant {each}, which is computed from {name}, has a kink or a jump at the present value of "
                f"{name}; change the value slightly"
            )
        result[each] = slope
    return result


class _Differences:
    """Difference quotients, for several step sizes, of numbers such as moments of inertia that depend on one variable.

    ``values`` takes a change of the variable and returns the numbers by name; ``step`` is the smallest step, ``name``
    the variable in messages.
    """

    # weights of second order at places in steps: central, then to the right and to the left, for example where the mass
    # would become negative
    SCHEMES: tuple[dict[int, Fraction], ...] = (
        {-1: Fraction(-1, 2), 1: Fraction(1, 2)},
        {0: Fraction(-3, 2), 1: Fraction(2), 2: Fraction(-1, 2)},
        {0: Fraction(3, 2), -1: Fraction(-2), -2: Fraction(1, 2)},
    )

    def __init__(self, values: Callable[[Fraction], Numbers], step: Fraction, name: str) -> None:
        self._values, self._step, self._points = values, step, dict[int, Numbers]()
        self.at(0)
        refusal: InputError | None = None
        for weights in self.SCHEMES:
            try:
                for place in weights:
                    self.at(place)
                    self.at(2 * place)
            except InputError as reason:
                refusal = refusal or reason
                continue
            self._weights, self.near = weights, tuple(weights)
            return
        raise InputError(f"sensitivities: expected a scene that stays valid if {name} changes, got {refusal}")

    def at(self, place: int) -> Numbers:
        """Return the numbers by name, such as moments of inertia, after the variable has changed by ``place`` steps.

        A step is the smallest step of the difference quotients; the variable changes from its present value.
        """
        if place not in self._points:
            self._points[place] = self._values(place * self._step)
        return self._points[place]

    def slope(self, each: str) -> Fraction | None:
        """Return the derivative of the number named ``each`` with respect to the variable, or None if there is none."""
        first, second = self._quotient(each, 1), self._quotient(each, 2)
        if self._bends(each):
            return None
        if abs(first - second) <= AGREEMENT * max(abs(first), abs(second)):
            return first
        # quotients that decrease with the step, as of x^3 or x*abs(x) at zero, have the limit zero
        third = self._quotient(each, 4)
        return Fraction(0) if abs(first) <= FALL * abs(second) and abs(second) <= FALL * abs(third) else None

    def _quotient(self, each: str, size: int) -> Fraction:
        total = sum((weight * self.at(size * place)[each] for place, weight in self._weights.items()), Fraction(0))
        return total / (size * self._step)

    def _bends(self, each: str) -> bool:
        """Return whether the number named ``each`` has a kink at the present value of the variable.

        At a kink, the second difference is proportional to the step, elsewhere to the square of the step. The result is
        False if only values of the variable on one side of the present one are valid.
        """
        if self._weights is not self.SCHEMES[0]:
            return False
        center = self.at(0)[each]
        near, far = (abs(self.at(-size)[each] - 2 * center + self.at(size)[each]) for size in (1, 2))
        return near > ROUNDED * max(abs(center), abs(self.at(1)[each])) and far <= BEND * near
