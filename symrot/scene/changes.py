"""Changes of a scene, such as ``weight=2``: finds the value that a key names and replaces it in the scene's content.

A key is a path in the scene file, such as ``body.mass`` or ``torque[0].weight``, or a short name, such as ``omega_2``,
``samples``, ``I_xx`` or ``weight``. Constants have the names that they have in the equations and in
:func:`symrot.propagate_ensemble`. Standard library only.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from fractions import Fraction
from itertools import islice
from typing import Any, NamedTuple

from symrot.dynamics.torque_kinds import TABLE_KIND, TORQUE_KINDS
from symrot.errors import InputError, with_hint
from symrot.formula.exact_numbers import show
from symrot.scene.body import Body
from symrot.scene.content import Content, plain
from symrot.scene.torque import Torque

__all__ = ["Path", "SceneContent", "changed", "in_order", "number_path", "path_of", "present_value", "set_last"]

Path = tuple[str | int, ...]

TABLES = ("schema", "title", "source", "body", "initial", "torque", "span", "output", "accuracy")
SHORT: dict[str, Path] = {
    "omega": ("initial", "omega"),
    "omega_space": ("initial", "omega_space"),
    "attitude": ("initial", "attitude"),
    "t": ("span", "t"),
    "samples": ("span", "samples"),
    "tolerance": ("accuracy", "tolerance"),
    "quantities": ("output", "quantities"),
    "sequence": ("output", "sequence"),
    "degrees": ("output", "degrees"),
}
EXCLUSIVE: dict[tuple[str | int, str | int], str] = {
    ("initial", "omega"): "omega_space",
    ("initial", "omega_space"): "omega",
    ("body", "mass"): "density",
    ("body", "density"): "mass",
    ("torque", "weight"): "gravity",
    ("torque", "gravity"): "weight",
}
"""(First key of a path, last key of the path) -> the key that may not stand in the same table as the last key.

The path leads to a value in the scene file: for ``body.part[0].mass`` the pair is ``("body", "mass")``, and the key
that it excludes is ``"density"``. A change that sets a value with one of the two keys removes a value with the other
key."""

RATES = ("omega_1", "omega_2", "omega_3")
MOST_STEPS = 1_000_000  # more than any path has
TENSOR = ("I_xx", "I_yy", "I_zz", "I_xy", "I_xz", "I_yz")
INDEX = {"x": 0, "y": 1, "z": 2}
NO_DIMENSIONS = ("shape", "part", "mesh", "flip", "principal", "inertia", "about", "fixed_point", "name")

_STEP = re.compile(r"([A-Za-z0-9_-]+)|\[(\d{1,6})\]")
_PREFIXED = re.compile(r"torque(\d{1,4})_(\w+)")


class Place(NamedTuple):
    """The place of a value in the content of a scene: its path, and an index from 0 if it is one number of a vector.

    Example: ``omega_2`` is ``(("initial", "omega"), 1)``.
    """

    path: Path
    component: int | None = None


class SceneContent(NamedTuple):
    """The content of a scene, and what was read from it: initial angular velocity, body and torques.

    ``content`` is the scene file as a dict. A number that the dict does not contain, because other numbers determine
    it, is read from ``omega_b``, ``body`` or ``torques``: for example, a body component of omega if the dict has only
    the space components ``omega_space``.
    """

    content: Content
    omega_b: Sequence[Fraction]
    body: Body
    torques: Sequence[Torque]


def changed(scene: SceneContent, changes: Mapping[str, Any]) -> Content:
    """Return the content of a scene in which the values named by the keys of ``changes`` are replaced.

    Parameters
    ----------
    scene : SceneContent
        The scene, whose content is not modified.
    changes : mapping
        Key -> value, as a scene file or a Python caller writes it.

    Raises
    ------
    InputError
        If a key names nothing in the scene, or both a constant of a torque and a dimension of the body, or if the value
        cannot be written into the table of the scene that the key leads to.
    """
    result = scene._replace(content=deepcopy(scene.content))
    for key, value in changes.items():
        _set(result, key, plain(value, f"{key}: "))
    return result.content


def present_value(scene: SceneContent, key: str) -> Any:
    """Return the present value that a key names.

    A value that the scene's content gives has the form that it has there, for instance the text ``"1/5"``; ``omega``,
    the principal moments and values that follow from others are fractions.

    Raises
    ------
    InputError
        If a key names nothing in the scene, or a value that the content does not determine.
    """
    if key in TENSOR:
        i, j = (INDEX[axis] for axis in key[-2:])
        return _tensor(scene)[i][j]
    if key == "principal":
        return list(scene.body.principal.moments)
    if key == "omega":
        return list(scene.omega_b)
    place = _place(scene, key)
    if place.component is not None:
        return _vector(scene, place.path)[place.component]
    value: Any = scene.content
    for step in place.path:
        inside = isinstance(value, dict) and step in value
        if not inside and not (isinstance(value, list) and isinstance(step, int) and step < len(value)):
            follows = _constant_of_torque(scene, place.path)
            if follows is not None:
                return list(follows) if isinstance(follows, tuple) else follows
            raise InputError(
                f"{key}: expected a value that the scene gives, but the scene does not give {_text(place)}"
            )
        value = value[step]
    return value


def number_path(scene: SceneContent, key: str) -> Path:
    """Return the path in the scene's content of the number or text that a key names.

    A key is a path or a short name, as for :meth:`symrot.Scene.with_`. If the first torque has a constant ``linear``,
    the key ``"linear"`` gives ``("torque", 0, "linear")``. The path is empty if the key names nothing, a table, a list,
    true or false, or one component of a vector.
    """
    try:
        place = _place(scene, key)
    except InputError:
        return ()
    value: Any = scene.content
    try:
        for step in place.path:
            value = value[step]
    except (KeyError, IndexError, TypeError):
        return ()
    return () if isinstance(value, bool | dict | list | tuple) or place.component is not None else place.path


def set_last(key: str) -> bool:
    """Return whether a change by ``key`` must come after the other changes, because it uses numbers that they may set.

    ``I_xx`` and ``center_of_mass`` replace the shapes of the body by moments of inertia, which follow from dimensions
    and masses. ``omega_2`` replaces one body component of omega and keeps the other two. If the scene gives omega in
    space components, these two follow from the attitude, which another change may set.
    """
    return key in (*TENSOR, *RATES, "principal") or str(key).rpartition(".")[2].startswith("center_of_mass")


def in_order(scene: SceneContent, changes: Mapping[str, Any]) -> Content:
    """Return ``changes`` in an order in which none overwrites an earlier one: ``omega`` before ``omega_2``.

    Raises
    ------
    InputError
        If two keys set the same value, or values that exclude each other, such as mass and density.
    """
    paths: dict[str, Path] = {}
    for key in changes:
        path = _whole_path(scene, key)
        for other, before in paths.items():
            if path and path == before:
                raise InputError(f"{key}: expected each value once, but {other} sets {_text(Place(path))} too")
            if path and before and _exclude(path, before):
                raise InputError(f"{key}: expected either {other} or {key}, since each replaces the other, got both")
        paths[key] = path
    # A key that names nothing yet may name something in a table that another change sets. The name center_of_mass alone
    # comes first, because it would name two values afterwards.
    rank = {key: (len(path) or MOST_STEPS, not str(key).startswith("center_of_mass")) for key, path in paths.items()}
    return {key: changes[key] for key in sorted(changes, key=lambda key: rank[key])}


def _whole_path(scene: SceneContent, key: str) -> Path:
    """Return the path of the value that ``key`` names in the scene file, down to the component of a vector.

    The path is () if no value or more than one value of the scene has this name. Another change may still add a value
    with this name.
    """
    if key == "principal":
        return ("body", "inertia")
    if key in TENSOR:
        return ("body", "inertia", key[-2:])
    try:
        place = _place(scene, key)
    except InputError:
        return ()
    return place.path if place.component is None else (*place.path, place.component)


def _exclude(one: Path, other: Path) -> bool:
    """Return whether the values at two paths exclude each other, as mass and density of one shape do."""
    # the first keys that differ, which are in the same table
    return any(_rival(one, a) == b for a, b in islice(((a, b) for a, b in zip(one, other, strict=False) if a != b), 1))


def _rival(path: Path, key: str | int) -> str:
    """Return the key that may not stand beside ``key``, such as ``"density"`` for ``"mass"``; empty if there is none.

    ``path`` is the path of a value in the same table.
    """
    # names of parameters are the user's
    return "" if "parameters" in path else EXCLUSIVE.get((path[0], key), "")


def _set(scene: SceneContent, key: str, value: Any) -> None:
    if key in TENSOR or key == "principal":
        _set_inertia(scene, key, value)
        return
    place = _place(scene, key)
    if place.component is not None:
        vector = [*_vector(scene, place.path)]
        vector[place.component] = value
        value = vector
    if place.path[0] == "torque" and place.path[-1] == "center_of_mass" and scene.body.center_of_mass is not None:
        scene.content["body"] = _moments(scene, _entries(_tensor(scene))) | {"center_of_mass": value}
        return
    parent, last = _table(scene.content, place.path[:-1], key), place.path[-1]
    if isinstance(parent, dict):
        parent.pop(_rival(place.path, last), None)
        parent[str(last)] = value
    elif isinstance(last, int) and last < len(parent):
        parent[last] = value
    else:
        raise InputError(f"{key}: expected an index from 0 to {len(parent) - 1}, got {last}")


def _place(scene: SceneContent, key: str) -> Place:
    """Return the place in the scene's content of the value that ``key`` names, such as ``omega_2`` or ``body.mass``.

    If several torques have a constant of this name, the constant of the first one is meant. InputError is raised for an
    unknown name, or for a name that a torque and the body share; a path is not checked beyond its first key.
    """
    if not isinstance(key, str):
        raise InputError(f"expected the name of a value of the scene, such as 'body.mass', got {show(key)}")
    if key in SHORT:
        return Place(SHORT[key])
    if key in RATES:
        return Place(("initial", "omega"), RATES.index(key))
    path = path_of(key)
    if not path:
        raise InputError(f"expected a name such as body.mass or torque[0].weight, got {show(key)}")
    if path[0] in TABLES:
        return Place(path)
    places = [*islice(_torque_places(scene, key), 1), *_body_places(scene, key)]
    if len(places) == 1:
        return places[0]
    if places:
        listed = " or ".join(map(_text, places))
        raise InputError(
            f"{key}: expected the name of one value of the scene, got a name that two values share; write {listed}"
        )
    known = [*TABLES[3:], *SHORT, *RATES, "principal", *TENSOR, *_names(scene)]
    raise InputError(with_hint(f"{key}: expected a path such as body.mass, or one of {', '.join(known)}", key, known))


def path_of(key: str) -> Path:
    """Return a dotted name as a path of keys and indices: ``torque[0].weight`` -> ``("torque", 0, "weight")``.

    The result is () if ``key`` is not a dotted name.
    """
    steps: list[str | int] = []
    position = 0
    for match in _STEP.finditer(key):
        between = key[position : match.start()]
        if between not in ("", ".") or (match[1] and steps and between != ".") or (match[2] and between):
            break
        steps.append(match[1] if match[1] else int(match[2]))
        position = match.end()
    return tuple(steps) if position == len(key) and steps and not isinstance(steps[0], int) else ()


def _torque_places(scene: SceneContent, key: str) -> Iterator[Place]:
    """Yield the place of each torque constant that ``key`` names, in the order of the torques.

    ``torque2_weight`` names a constant of the second torque only; ``weight`` names one in each torque that has a
    weight.
    """
    prefixed = _PREFIXED.fullmatch(key)
    candidates = [(int(prefixed[1]) - 1, prefixed[2])] if prefixed else [(k, key) for k in range(_count(scene))]
    for index, name in candidates:
        if 0 <= index < _count(scene):
            place = _torque_place(scene.content["torque"][index], index, name)
            if place is not None:
                yield place


def _count(scene: SceneContent) -> int:
    return len(scene.content.get("torque", ()))


def _torque_place(torque: Content, index: int, name: str) -> Place | None:
    kind = torque["kind"]
    if kind == TABLE_KIND.kind:
        return None
    if kind == "expression":
        known = name in torque.get("parameters", {})
        return Place(("torque", index, "parameters", name)) if known else None
    fields = {field.name: field.shape for field in TORQUE_KINDS[kind].fields}
    if name in fields:
        return Place(("torque", index, name))
    stem, _, number = name.rpartition("_")
    if number in ("1", "2", "3") and "vector" in fields.get(stem, ""):
        return Place(("torque", index, stem), int(number) - 1)
    return None


def _body_places(scene: SceneContent, key: str) -> Iterator[Place]:
    body = scene.content["body"]
    if key == "mass" and "part" not in body:
        yield Place(("body", "mass"))
    elif key == "density" and ("shape" in body or "mesh" in body):
        yield Place(("body", "density"))
    elif key in body and key not in NO_DIMENSIONS and key not in SHORT:
        yield Place(("body", key))


def _names(scene: SceneContent) -> list[str]:
    """Return the short names of the torques' constants and of the body's dimensions, for an error message."""
    names: list[str] = []
    for torque in scene.content.get("torque", ()):
        if torque["kind"] == "expression":
            names += torque.get("parameters", {})
        elif torque["kind"] != TABLE_KIND.kind:
            names += [field.name for field in TORQUE_KINDS[torque["kind"]].fields]
    names += [key for key in scene.content["body"] if key not in NO_DIMENSIONS]
    return [*dict.fromkeys(names)]


def _text(place: Place) -> str:
    text = ""
    for step in place.path:
        text += f"[{step}]" if isinstance(step, int) else f".{step}" if text else step
    return text


def _table(content: Content, path: Path, key: str) -> Any:
    """Return the table or list at a path of the content; missing tables on the way are added."""
    place: Any = content
    for depth, step in enumerate(path):
        if isinstance(step, int):
            if not isinstance(place, list) or step >= len(place):
                size = len(place) if isinstance(place, list) else 0
                items = _text(Place(path[:depth]))
                raise InputError(f"{key}: expected an index below {size}, the length of {items}, got {step}")
            place = place[step]
        elif isinstance(place, dict):
            place = place.setdefault(step, {})
        else:
            raise InputError(f"{key}: expected a table at {_text(Place(path[:depth]))}, got {show(place)}")
    if not isinstance(place, dict | list):
        raise InputError(f"{key}: expected a table at {_text(Place(path))}, got {show(place)}")
    return place


def _vector(scene: SceneContent, path: Path) -> Sequence[Any]:
    """Return the three components of the vector to which ``path`` leads in the scene's content.

    A change of one component replaces the whole vector. If the content has the vector in another form, such as
    ``omega_space``, the result is computed from the scene.
    """
    place: Any = scene.content
    if path[-1] == "center_of_mass" and "center_of_mass" in scene.content["body"]:
        path = ("body", "center_of_mass")
    for step in path:
        place = place[step] if isinstance(step, int) else place.get(step) if isinstance(place, dict) else None
    if isinstance(place, list) and len(place) == 3:
        return place
    # the content gives the vector in another form, such as omega_space
    if path == ("initial", "omega"):
        return scene.omega_b
    vector = _constant_of_torque(scene, path)
    assert isinstance(vector, tuple)
    return vector


def _constant_of_torque(scene: SceneContent, path: Path) -> Fraction | tuple[Fraction, ...] | None:
    """Return the exact value of a torque's constant that the file does not give, but that follows from other values.

    The weight, for instance, follows from the mass and the acceleration of gravity. None if ``path`` leads to no
    constant of a torque.
    """
    kinds = [torque.get("kind") for torque in scene.content.get("torque", ())]
    if path[0] != "torque" or len(path) != 3 or not isinstance(path[1], int) or path[1] >= len(kinds):
        return None
    if kinds[path[1]] == TABLE_KIND.kind:
        return None
    # scene.torques has no torques of kind table, so its indices are smaller after a table
    own = scene.torques[path[1] - kinds[: path[1]].count(TABLE_KIND.kind)]
    return own.values.get(str(path[2]))


def _set_inertia(scene: SceneContent, key: str, value: Any) -> None:
    """Set the principal moments (key ``"principal"``) or an entry of the inertia tensor, such as ``"I_xy"``.

    Mass and centre of mass stay; a body that was given by shapes is then given by its moments.
    """
    if key == "principal":
        if not scene.body.principal.given_axes:
            raise InputError(
                "principal: expected a body given along its principal axes, got a body with products of inertia; "
                f"change {', '.join(TENSOR)} instead"
            )
        inertia: Content = {"principal": value}
    else:
        tensor = _tensor(scene)
        i, j = (INDEX[axis] for axis in key[-2:])
        tensor[i][j] = tensor[j][i] = value
        inertia = _entries(tensor)
    scene.content["body"] = _moments(scene, inertia)


def _moments(scene: SceneContent, inertia: Content) -> Content:
    """Return the table ``[body]`` of a scene with moments of inertia instead of shapes.

    The moments are ``inertia``, such as ``{"principal": [1, 2, 3]}``. Name, mass and centre of mass stay the same.
    """
    body, content = scene.body, scene.content["body"]
    moments: Content = {**inertia, "about": body.about, "name": content.get("name", "")}
    if body.mass is not None:
        moments["mass"] = body.mass
    if body.about == "fixed_point" and body.center_of_mass is not None:
        moments["center_of_mass"] = content.get("center_of_mass", list(body.center_of_mass))
    return moments


def _entries(tensor: list[list[Any]]) -> Content:
    return {"inertia": {name[-2:]: tensor[INDEX[name[-2]]][INDEX[name[-1]]] for name in TENSOR}}


def _tensor(scene: SceneContent) -> list[list[Any]]:
    """Return the rows of the scene's inertia tensor as its file gives them, or as computed if its file gives shapes."""
    match scene.content["body"]:
        case {"principal": [a, b, c]}:
            return [[a, 0, 0], [0, b, 0], [0, 0, c]]
        case {"inertia": dict(entries)}:
            xx, xy, xz, yy, yz, zz = (entries.get(key, 0) for key in ("xx", "xy", "xz", "yy", "yz", "zz"))
            return [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        case {"inertia": [list(), list(), list()] as rows}:
            return deepcopy(rows)
    return [list(row) for row in scene.body.inertia]
