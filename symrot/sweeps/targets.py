"""Targets: the quantities of a scene that a sweep can vary.

A target is a component of the initial angular velocity, ``omega_1``; a constant of the equations of motion, ``weight``
or ``I_xx``; or a number in the scene file, ``body.mass`` or ``body.part[0].radius``.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NoReturn

from symrot.dynamics.torque_kinds import TABLE_KIND, TORQUE_KINDS
from symrot.ensemble.reading import FIXED, constant_places
from symrot.ensemble.variation import PLACES
from symrot.errors import InputError, with_hint
from symrot.formula.exact_numbers import read, show
from symrot.scene.changes import Path, SceneContent, number_path, path_of
from symrot.scene.scene import Scene

__all__ = ["OMEGA", "Content", "Path", "Target", "constants_of", "read_target"]

OMEGA = ("omega_1", "omega_2", "omega_3")
VARIED_TABLES = ("body", "initial", "torque")
FROM_BODY = {"gravity": ("weight", "center_of_mass")}  # fields of a torque that may depend on the body

Content = Mapping[str, Any]


# Constants are passed to the ensemble as they are. For a number in the file, the scene is read again with each value,
# so that everything follows: the mass of a shape changes its inertia, centre of mass and weight.
@dataclass(frozen=True)
class Target:
    """A quantity that a sweep varies: a component of omega, a constant of the equations, or a number in the scene file.

    ``path`` is the path of a number in the scene file, whose ``unit`` is empty because it is not known; for the other
    quantities, the path is ().
    """

    name: str
    unit: str
    path: Path = ()


def read_target(name: str, scene: Scene, content: Content | None) -> Target:
    """Return the target with the given name.

    Parameters
    ----------
    name : str
        ``omega_1`` to ``omega_3``, a constant of the scene, a path in the scene file, or a short name of a number in
        it, as for :meth:`symrot.Scene.with_`: ``linear`` for ``torque[0].linear``.
    scene : Scene
        The scene.
    content : mapping or None
        The content of the scene file or dict; None if it is not known.

    Raises
    ------
    InputError
        If the scene has no quantity with this name, or if this quantity cannot vary.
    """
    if not isinstance(name, str):
        raise InputError(f"vary: expected the name of a value, such as 'omega_1', got {show(name)}")
    if name in OMEGA:
        return Target(name, "rad/s")
    places = constant_places(scene)
    if name in places:
        _require_variable(places[name].field, name)
        return Target(name, _unit_of_constant(scene, name))
    path = _path(name)
    if not path and content is not None:
        short = number_path(SceneContent(dict(content), scene.initial.omega_b, scene.body, scene.torques), name)
        path = short if short and short[0] in VARIED_TABLES else ()
    if path and content is None:
        raise InputError(f"{name}: expected the scene as a file or a dict, to vary a number in it, got a Scene object")
    known = [*OMEGA, *(key for key, place in places.items() if place.field not in FIXED)]
    if not path or content is None:
        paths = [] if content is None else [text for text in _numbers_in(content) if not _is_fixed(text)]
        listed = ", ".join(known)
        if paths:
            listed += f", or a number in the scene file such as {', '.join(paths[:3])}"
        message = f"expected a value that can vary, {listed}, got {show(name)}"
        raise InputError(with_hint(message, name, [*known, *paths]))
    _require_number(name, path, content)
    return Target(name, "", path)


def _path(name: str) -> Path:
    """Return the path for a name such as ``body.part[0].radius``: ``("body", "part", 0, "radius")``.

    It is () unless the name is a path in one of the tables :data:`VARIED_TABLES`.
    """
    path = path_of(name)
    return path if len(path) > 1 and path[0] in VARIED_TABLES else ()


def _is_fixed(name: str) -> bool:
    return any(token in FIXED for token in _path(name))


def _require_variable(field: str, name: str) -> None:
    if field in FIXED:
        raise InputError(
            f"{name}: expected a value that can vary, but {field} is the same for all trajectories; {FIXED[field]}"
        )


def _unit_of_constant(scene: Scene, name: str) -> str:
    if name in PLACES:
        return "kg m^2"
    place = constant_places(scene)[name]
    fields = {field.name: field.unit for field in TORQUE_KINDS[scene.torques[place.torque].kind].fields}
    return "" if place.field == "parameters" else fields[place.field]


def _require_number(name: str, path: Path, content: Content) -> None:
    value: Any = content
    for token in path:
        is_key = isinstance(token, str) and isinstance(value, Mapping) and token in value
        is_place = isinstance(token, int) and isinstance(value, list | tuple) and token < len(value)
        if not (is_key or is_place):
            _refuse(name, content)
        value = value[token]
    if path[0] == "torque":
        if content["torque"][path[1]].get("kind") == TABLE_KIND.kind:
            raise InputError(f"{name}: expected a torque given by formulas, got a torque of kind {TABLE_KIND.kind}")
        _require_variable(str(path[2]), name)
    read(value, name, "a place in the scene file that contains a number")


def _refuse(name: str, content: Content) -> NoReturn:
    paths = _numbers_in(content)
    message = f"expected a number in the scene file, such as {', '.join(paths[:6])}, got {show(name)}"
    raise InputError(with_hint(message, name, paths))


def _numbers_in(content: Content) -> list[str]:
    """Return the paths, as texts, of the numbers in VARIED_TABLES of a scene, for hints in error messages.

    Numbers that the scene gives as text, such as ``"1/3"``, are left out.
    """

    def walk(value: Any, place: str) -> list[str]:
        if isinstance(value, Mapping):
            return [path for key, item in value.items() for path in walk(item, f"{place}.{key}")]
        if isinstance(value, list | tuple):
            return [path for k, item in enumerate(value) for path in walk(item, f"{place}[{k}]")]
        return [] if isinstance(value, bool | str) else [place]

    return [path for key in VARIED_TABLES if key in content for path in walk(content[key], key)]


def constants_of(path: Path, scene: Scene, content: Content) -> list[str]:
    """Return the names of the constants of the equations that the number at ``path`` may change, such as ``I_xx``.

    The result depends on the table in which the number stands, not on the value of the number.
    """
    places = constant_places(scene)
    if path[0] == "initial":
        return []
    if path[0] == "body":
        from_body = [
            name
            for name, place in places.items()
            if place.torque >= 0 and place.field in FROM_BODY.get(scene.torques[place.torque].kind, ())
        ]
        return [*PLACES, *from_body]
    kinds = [torque["kind"] for torque in content["torque"][: path[1]]]
    index = len(kinds) - kinds.count(TABLE_KIND.kind)
    own = [name for name, place in places.items() if place.torque == index and place.field not in FIXED]
    return [name for name in own if places[name].entry != "pi"]
