"""Torques of scenes, read by means of the table in :mod:`symrot.dynamics.torque_kinds`.

If a torque does not specify a value such as the centre of mass, the value of the body is used.
"""

import math
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from symrot.dynamics.torque_kinds import EXPRESSION_NAMES, TABLE_KIND, TORQUE_KINDS, Field, TorqueKind
from symrot.errors import InputError
from symrot.formula import tree as expression
from symrot.formula.exact_numbers import PI, read, show, sqrt
from symrot.formula.float_functions import FLOAT_FUNCTIONS
from symrot.formula.switches import condition_error
from symrot.scene.attitude import Vector, read_attitude
from symrot.scene.body import Body
from symrot.scene.reader import Entry, Reader, choice, fail, items, key_path, number, read_table, table, vector

__all__ = ["Torque", "Value", "read_torque"]

DEEPEST_FORMULA = 150
LONGEST_FORMULA = 2000
MOST_PARAMETERS = 100


Value = Fraction | tuple[Fraction, ...]
"""A constant of a torque: a number, a vector, or the quaternion of an attitude."""


class Torque(NamedTuple):
    """One torque of a scene: its kind and its constants.

    Attributes
    ----------
    kind : str
        Name in the table of torques.
    values : mapping
        The constants by name, in SI units. For a torque given by formulas they are its parameters, and pi if a formula
        contains pi or atan2; otherwise they are all fields of its kind in the table of torques. An attitude is a unit
        quaternion, and ``linear`` of a damping is a vector. Gravity has ``weight``, ``center_of_mass`` and a unit
        vector ``direction``.
    formulas : tuple of str
        The components of a torque given by formulas, as text for :func:`symrot.formula.tree.parse`; they may contain
        functions with jumps or kinks.
    frame : str
        ``"body"`` or ``"space"``: the frame of the components.
    warnings : tuple of str
        Sentences about parameters that no formula contains.

    Examples
    --------
    >>> import symrot
    >>> symrot.load_scene("heavy_top_loops").torques[0].kind
    'gravity'
    """

    kind: str
    values: Mapping[str, Value]
    formulas: tuple[str, ...] = ()
    frame: str = "body"
    warnings: tuple[str, ...] = ()

    def number(self, name: str) -> Fraction:
        """Return the number that is the constant ``name`` of the torque, such as ``"weight"``."""
        value = self.values[name]
        assert isinstance(value, Fraction)
        return value

    def vector(self, name: str) -> tuple[Fraction, ...]:
        """Return the constant ``name`` of the torque: a vector, such as ``"center_of_mass"``, or a quaternion."""
        value = self.values[name]
        assert isinstance(value, tuple)
        return value

    def constant(self, name: str, component: int | None) -> Fraction:
        """Return the constant ``name``, a number (``component`` is None), or its component with this index, from 0."""
        return self.number(name) if component is None else self.vector(name)[component]

    def with_constant(self, name: str, component: int | None, value: Fraction) -> "Torque":
        """Return a copy of the torque in which one number has the value ``value``.

        ``name`` and ``component`` say which number, see :meth:`constant`.
        """
        if component is None:
            return self._replace(values={**self.values, name: value})
        vector = tuple(value if k == component else entry for k, entry in enumerate(self.vector(name)))
        return self._replace(values={**self.values, name: vector})


# --- fields -----------------------------------------------------------------------------------------------------------


def _scalar_or_vector(field: Field) -> Reader:
    one = number(f"a number in {field.unit}, or three of them", field.sign)
    three = vector(field.unit, field.sign)

    def reader(value: Any, where: str) -> Vector:
        if isinstance(value, list | tuple):
            components: Vector = three(value, where)
            return components
        x = one(value, where)
        return x, x, x

    return reader


def _rest(value: Any, where: str) -> tuple[Fraction, ...]:
    return read_attitude(value, where).quaternion


def _depth(node: expression.Node) -> int:
    """Return the depth of a formula tree: the largest number of nodes from the root to a leaf."""
    # not by recursion, since the tree of a long sum is very deep
    depth, level = 0, [node]
    while level:
        depth, level = depth + 1, [child for parent in level for child in expression.children(parent)]
    return depth


def _formula(value: Any, where: str) -> str:
    """Return one component of a torque, a formula or a number in the scene, as formula text."""
    if not isinstance(value, str):
        return str(read(value, where, 'a formula as text, such as "-k*omega_1", or a number'))
    if len(value) > LONGEST_FORMULA:
        fail(where, f"a formula of at most {LONGEST_FORMULA} characters", value, f"it has {len(value)}")
    # text that is no formula raises InputError
    node = expression.parse(value, where, switching=True)
    if _depth(node) > DEEPEST_FORMULA:
        fail(where, f"a formula of at most {DEEPEST_FORMULA} levels", value,
                 "each further term of a sum adds a level; put brackets around groups of terms")  # fmt: skip
    if error := condition_error(node):
        fail(where, error, value)
    if _divides_by_zero(node):
        fail(where, "a formula with finite values", value, "it divides by zero")
    return value.strip()


def _divides_by_zero(node: expression.Node) -> bool:
    """Return whether a formula contains a division by a constant that is zero, as in ``1/(2 - 2)``."""
    if any(map(_divides_by_zero, expression.children(node))):
        return True
    divisor = node[2] if node[0] == "/" else node[1] if node[0] == "**" and node[2] < 0 else None
    if divisor is None or expression.names(divisor):
        return False
    try:
        return bool(expression.evaluate(divisor, {}) == 0)
    except KeyError:  # a function of a number
        return False


_formulas = items(3, _formula, "three formulas, one for each component")
_parameter = number("a number")


def _parameters(value: Any, where: str) -> dict[str, Fraction]:
    entries = table(value, where, "a table of numbers by name, such as {k = 0.1}")
    if len(entries) > MOST_PARAMETERS:
        fail(where, f"at most {MOST_PARAMETERS} parameters", len(entries))
    reserved = {*EXPRESSION_NAMES, *expression.FUNCTIONS, *expression.SWITCHING, *expression.LOGIC, "not", "pi"}
    for name in entries:
        if (
            not isinstance(name, str)
            or not (name.isascii() and name.isidentifier())
            or len(name) > 40
            or name in reserved
        ):
            fail(key_path(where, name), "a parameter whose name consists of letters, digits and underscores and is "
                     f"not a name that formulas know already ({', '.join(sorted(reserved))})", name)  # fmt: skip
    return {name: _parameter(item, f"{where}.{name}") for name, item in entries.items()}


_FIELD_READERS: dict[str, Callable[[Field], Reader]] = {
    "scalar": lambda field: number(f"a number in {field.unit}", field.sign),
    "vector": lambda field: vector(field.unit, field.sign),
    "scalar or vector": _scalar_or_vector,
    "attitude": lambda field: _rest,
    "formulas": lambda field: _formulas,
    "parameters": lambda field: _parameters,
    "body|space": lambda field: choice("body", "space"),
}


def _entries(kind: TorqueKind) -> dict[str, Entry]:
    return {
        "kind": Entry(choice(kind.kind), required=True),
        **{field.name: Entry(_FIELD_READERS[field.shape](field), field.required, field.default)
           for field in kind.fields},
    }  # fmt: skip


# --- what needs the body ----------------------------------------------------------------------------------------------


def _fit_gravity(values: dict[str, Any], body: Body, where: str) -> dict[str, Any]:
    """Return the values of a ``gravity`` torque: the weight, the centre of mass, and the unit vector ``direction``."""
    weight, acceleration, center = values["weight"], values["gravity"], values["center_of_mass"]
    if weight is not None and acceleration is not None:
        fail(f"{where}.gravity", "weight or gravity, not both", acceleration)
    if weight is None and acceleration is None:
        fail(f"{where}.weight", "the weight in N, or gravity in m/s^2 for a body with a mass; both keys are missing")
    if weight is None and body.mass is None:
        fail(f"{where}.gravity", "the weight in N: the mass of the body is unknown", acceleration)
    if center is not None and body.center_of_mass is not None and center != body.center_of_mass:
        known = [float(item) for item in body.center_of_mass]
        fail(f"{where}.center_of_mass", f"no value, or the same as for the body: {show(known)} m from the fixed point",
                 [float(item) for item in center])  # fmt: skip
    # not in the table: the body's; likewise its mass times gravity is the weight
    if center is None:
        center = body.center_of_mass
    if center is None:
        fail(f"{where}.center_of_mass", "three numbers [x, y, z] in m from the fixed point: the body is given by "
                 "its moments of inertia, so its centre of mass is unknown")  # fmt: skip
    if not any(center):
        fail(where, "a fixed point away from the centre of mass, since the weight has no torque about that centre",
                 [float(item) for item in center])  # fmt: skip
    x, y, z = values["direction"]
    length = sqrt(x * x + y * y + z * z)
    return {
        "weight": weight if weight is not None else acceleration * body.mass,
        "center_of_mass": center,
        "direction": (x / length, y / length, z / length),
    }


def _fit_damping(values: dict[str, Any], body: Body, where: str) -> dict[str, Any]:
    if not any(values["linear"]) and not values["quadratic"]:
        fail(where, "a damping with linear or quadratic > 0, got neither")
    return values


def _fit_expression(values: dict[str, Any], body: Body, where: str) -> dict[str, Any]:
    """Return the values of an ``expression`` torque, with warnings about parameters that no formula contains.

    Raise InputError if a formula contains a name that is neither a parameter nor a quantity such as omega_1.
    """
    parameters = dict(values["parameters"])
    known = {*EXPRESSION_NAMES, *parameters, "pi"}
    unused = set(parameters)
    for index, formula in enumerate(values["torque"]):
        node = expression.parse(formula, switching=True)
        if "atan2" in expression.operations(node):  # continued across its branch cut, by multiples of pi
            parameters["pi"] = PI
        for name in sorted(expression.names(node)):
            if name not in known:
                allowed = ", ".join([*EXPRESSION_NAMES, *parameters])
                from symrot.formula.advice import name_advice  # only on the way to an error

                reason = ", ".join(filter(None, (f"'{name}' has no number in parameters", name_advice(name, known))))
                fail(f"{where}.torque[{index}]", f"a formula in {allowed}", formula, reason)
            if name == "pi":
                parameters["pi"] = PI
            unused.discard(name)
        _check_clips(node, {name: float(value) for name, value in parameters.items()} | {"pi": math.pi}, where, index)
    warnings = tuple(
        f"{where}.parameters.{name}: no formula of this torque contains this parameter, so it has no effect"
        for name in sorted(unused)
    )
    return {**values, "parameters": parameters, "warnings": warnings}


def _check_clips(node: expression.Node, values: Mapping[str, float], where: str, index: int) -> None:
    """Raise InputError if a formula contains ``clip(u, low, high)`` with low > high."""
    for child in expression.children(node):
        _check_clips(child, values, where, index)
    if node[0] != "call" or node[1] != "clip":
        return
    low, high = node[2][1:]
    # only limits that are numbers or parameters are compared
    if not (expression.names(low) | expression.names(high)) <= set(values):
        return
    try:
        bounds = [expression.evaluate(limit, values, _MATH, float) for limit in (low, high)]
    except (KeyError, ArithmeticError, ValueError):  # a function that jumps; no value
        return
    if bounds[0] > bounds[1]:
        fail(f"{where}.torque[{index}]", "clip(u, low, high) with low <= high", expression.text(node),
                 f"low is {show(bounds[0])}, high is {show(bounds[1])}")  # fmt: skip


_MATH: dict[str, Callable[..., float]] = {**FLOAT_FUNCTIONS, "min": min, "max": max, "floor": math.floor}

_FITS: dict[str, Callable[[dict[str, Any], Body, str], dict[str, Any]]] = {
    "gravity": _fit_gravity,
    "damping": _fit_damping,
    "expression": _fit_expression,
}

_ABOUT_ADVICE = {
    "fixed_point": 'about = "fixed_point" in [body]: a weight has no torque about the centre of mass',
    "center_of_mass": 'about = "center_of_mass" in [body]: a satellite rotates about its centre of mass',
}


def read_torque(value: Any, body: Body, where: str) -> Torque:
    """Return the torque that one table ``[[torque]]`` describes; missing values are the defaults of its kind.

    Gravity takes a missing weight and centre of mass from the body.

    Raises
    ------
    InputError
        If a kind, a key or a name in a formula is unknown, a value is out of range, or a torque of this kind cannot act
        on the body, such as gravity on a body that rotates about its centre of mass.
    """
    kinds = (*TORQUE_KINDS, TABLE_KIND.kind)
    entries = table(value, where, f"a table with a kind, one of {', '.join(kinds)}")
    if "kind" not in entries:
        fail(f"{where}.kind", f"one of {', '.join(kinds)}; the key is missing")
    name = choice(*kinds)(entries["kind"], f"{where}.kind")
    kind = TORQUE_KINDS[name]
    values = read_table(entries, where, _entries(kind), f"a torque of kind {name}")
    del values["kind"]
    if kind.about not in ("any", body.about):
        fail(f"{where}.kind", _ABOUT_ADVICE[kind.about], name)
    fit = _FITS.get(name)
    try:
        fields = fit(values, body, where) if fit else values
        if name == "expression":
            formulas = tuple(fields["torque"])
            return Torque(name, fields["parameters"], formulas, fields["frame"], fields["warnings"])
        return Torque(name, fields)
    except RecursionError:
        raise InputError(f"{where}: expected a formula with fewer nested levels, got {show(entries)}") from None
