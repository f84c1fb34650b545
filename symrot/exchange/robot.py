"""Reading of the inertials of robot files (URDF, MJCF, SDF), and the test that a body can have these values."""

import re
from collections.abc import Callable, Collection, Mapping
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

from symrot.errors import InputError, with_hint
from symrot.exchange.inertial import Inertial
from symrot.exchange.orientation import ORIENTATIONS, Angles, of_quaternion, of_roll_pitch_yaw
from symrot.exchange.xml_file import read_xml
from symrot.files.paths import path_of
from symrot.formula.exact_numbers import show
from symrot.inertia.principal import principal_axes, require_admissible
from symrot.inertia.tensor import IDENTITY, Tensor, matrix, rotate

__all__ = ["FORMATS", "Format", "Link", "link", "links", "read_robot"]

LARGEST = Fraction(10) ** 100
_NUMBER = re.compile(r"[+-]?(\d{1,400}\.?\d{0,400}|\.\d{1,400})([eE][+-]?\d{1,3})?", re.ASCII)
_ENTRIES = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


class Link(NamedTuple):
    """A link of a robot file with its inertial, or with the reason why it has no valid inertial.

    Attributes
    ----------
    name : str
        Name of the link; names of its models in front of it, as in ``"arm::base"``, if another link has the same name.
    inertial : Inertial or None
        Mass, centre and tensor, in the axes of the link; None if there is a problem.
    problem : str
        A clause such as ``"expected a positive mass, got 0"``; empty if there is none.
    empty : bool
        Whether the link has no element ``<inertial>``, as is usual for links that only mark a frame or a sensor.

    Examples
    --------
    >>> Link("tool", None, "expected an element <inertial>, got none", empty=True).name
    'tool'
    """

    name: str
    inertial: Inertial | None
    problem: str = ""
    empty: bool = False


class Format(NamedTuple):
    """A format of robot files: its name, the tag of a link, the path to all links, and the reader of an inertial.

    ``other`` is the path to elements of the same tag that are no links.
    """

    name: str
    tag: str
    path: str
    read: Callable[[Element, Element], Inertial]
    other: str = ""

    def elements(self, root: Element) -> list[Element]:
        """Return the elements of all links in the XML tree ``root``.

        Elements with the same tag at other places, as in plugins, are not links.
        """
        others = set(root.findall(self.other)) if self.other else set()
        return [element for element in root.findall(self.path) if element not in others]

    def links(self, root: Element) -> list[tuple[str, Element]]:
        """Return the elements of all links, each with its name.

        Links of several models in an SDF file may have the same name. The names of the models then stand in front of
        it, as in ``arm::base``.
        """
        elements = self.elements(root)
        names = [element.get("name", "") for element in elements]
        models = {child: parent for parent in root.iter() for child in parent}

        def whole(element: Element) -> str:
            name = element.get("name", "")
            while (element := models.get(element, root)) is not root:
                name = f"{element.get('name', '')}::{name}" if element.tag == "model" else name
            return name

        return [
            (whole(element) if names.count(name) > 1 else name, element)
            for name, element in zip(names, elements, strict=True)
        ]


def links(path: str | Path) -> tuple[Link, ...]:
    """Return all links of a robot file, each with its inertial or with the reason why it has no valid inertial.

    Parameters
    ----------
    path : str or Path
        A file in the format URDF, MJCF or SDF.

    Returns
    -------
    tuple of Link
        In the order of the file.

    Raises
    ------
    InputError
        If the file is not such a file or has no links.

    Examples
    --------
    >>> import symrot
    >>> for each in symrot.links("robot.urdf"):  # doctest: +SKIP
    ...     print(each.name, each.problem or each.inertial)
    """
    form, root = read_robot(path)[:2]
    return tuple(_link(form, root, name, element) for name, element in _links(form, root, str(path)))


def link(path: str | Path, name: str = "") -> Inertial:
    """Return mass, centre of mass and inertia of a link of a robot file, in the axes of the link.

    Parameters
    ----------
    path : str or Path
        A file in the format URDF, MJCF or SDF.
    name : str
        Name of the link (in MJCF: of the body), as :func:`links` returns it; it may be omitted if there is only one.

    Returns
    -------
    Inertial
        Computed exactly from the numbers of the file, except for rotations (errors of 2^-300). ``table()`` returns the
        table ``body`` of a scene.

    Raises
    ------
    InputError
        If there is no such link, if it has no inertial, or if no body can have its mass and tensor; the message names
        the link and the numbers.

    Examples
    --------
    >>> import symrot
    >>> arm = symrot.link("robot.urdf", "upper_arm")  # doctest: +SKIP
    >>> body = arm.table()  # doctest: +SKIP
    """
    form, root = read_robot(path)[:2]
    every = _links(form, root, str(path))
    names = [each for each, _ in every]
    if not name and len(every) > 1:
        raise InputError(f"{path}: expected the name of one of its links, {_listed(names)}, got none")
    same = [(each, element) for each, element in every if name in ("", each)]
    if not same:
        message = f"{path}: expected one of its links, {_listed(names)}, got {show(name)}"
        raise InputError(with_hint(message, name, names))
    if len(same) > 1:
        raise InputError(f"{path}: expected one link of the name {show(name)}, got {len(same)}")
    result = _link(form, root, *same[0])
    if result.inertial is None:
        raise InputError(f"{path}: link {show(result.name)}: {result.problem}")
    return result.inertial


def _listed(names: list[str]) -> str:
    return ", ".join(names[:20]) + (", .." if len(names) > 20 else "")


def read_robot(path: str | Path) -> tuple[Format, Element, bytes]:
    """Return the format of a robot file (URDF, MJCF or SDF), its root element, and its bytes."""
    content, root = read_xml(path_of(path, "robot"), str(path))
    if root.tag not in FORMATS:
        tags = ", ".join(f"<{tag}> ({form.name})" for tag, form in FORMATS.items())
        raise InputError(f"{path}: expected a robot file, {tags}, got an XML file with the root <{root.tag[:60]}>")
    return FORMATS[root.tag], root, content


def _links(form: Format, root: Element, where: str) -> list[tuple[str, Element]]:
    """Return the name and the element of each link; raise InputError if there are none."""
    every = form.links(root)
    if not every:
        reason = "; files that it includes are not read" if root.find(".//include") is not None else ""
        raise InputError(f"{where}: expected a robot with links (<{form.tag}>), got none{reason}")
    return every


def _link(form: Format, root: Element, name: str, element: Element) -> Link:
    try:
        inertial = form.read(element, root)
        _require_body(inertial)
    except InputError as problem:
        return Link(name, None, str(problem), element.find("inertial") is None)
    return Link(name, inertial)


def _require_body(inertial: Inertial) -> None:
    if inertial.mass <= 0:
        raise InputError(f"expected a positive mass in kg, got {float(inertial.mass):.6g}")
    principal = principal_axes(inertial.inertia)
    require_admissible(principal)
    if min(principal.moments) <= 0:
        moments = ", ".join(f"{float(moment):.15g}" for moment in principal.moments)
        raise InputError(f"expected three positive principal moments of inertia, got {moments} kg m^2")


# --- numbers ----------------------------------------------------------------------------------------------------------


def _numbers(text: str | None, count: int, place: str) -> tuple[Fraction, ...]:
    """Return the numbers in the text of an attribute or element; ``place`` names it in error messages.

    Raise InputError unless there are ``count`` of them, each zero or of a magnitude from 1e-100 to 1e100.
    """
    words = (text or "").split()
    if "$" in (text or ""):
        raise InputError(f"{place}: expected numbers, got {show(text)}; expand the file with xacro first")
    if len(words) != count:
        raise InputError(f"{place}: expected {count} {'number' if count == 1 else 'numbers'}, got {show(text or '')}")
    for word in words:
        if not _NUMBER.fullmatch(word):
            raise InputError(f"{place}: expected a number, got {show(word)}")
    values = tuple(map(Fraction, words))
    for value, word in zip(values, words, strict=True):
        if value and not 1 / LARGEST <= abs(value) <= LARGEST:
            raise InputError(f"{place}: expected a number of a magnitude between 1e-100 and 1e100, got {show(word)}")
    return values


def _one(element: Element, tag: str, place: str) -> Element:
    """Return the child element with the given tag; raise InputError, with ``place``, unless there is exactly one."""
    children = element.findall(tag)
    if len(children) != 1:
        raise InputError(f"{place}: expected one element <{tag}>, got {len(children) or 'none'}")
    return children[0]


def _inertial(element: Element, reason: str) -> Element:
    if element.find("inertial") is None:
        raise InputError(f"expected an element <inertial>, got none{reason}")
    return _one(element, "inertial", "link")


def _require_known(element: Element, attributes: Collection[str], children: Collection[str]) -> None:
    """Raise InputError if ``element`` has an attribute, or a child element, that its format does not define.

    The reader would ignore such a part, for example a rotation under a name from another version of the format.
    """
    for kind, names, known in (
        ("attributes", element.keys(), attributes), ("elements", [child.tag for child in element], children)
    ):  # fmt: skip
        unknown = next((str(name) for name in names if name not in known), None)
        if unknown is not None:
            listed = f"{kind} among {', '.join(known)}" if known else f"no {kind}"
            raise InputError(f"{element.tag}: expected {listed}, got {show(unknown)}")


def _flag(text: str, place: str) -> bool:
    """Return the truth value in an attribute of SDF, in which upper and lower case are the same."""
    if text.lower() not in ("true", "1", "false", "0"):
        raise InputError(f"{place}: expected true or false, got {show(text)}")
    return text.lower() in ("true", "1")


def _body(
    element: Element, mass: Fraction, center: tuple[Fraction, ...], tensor: Tensor, rotation: Tensor | None
) -> Inertial:
    """Return the inertial of a link in the axes of the link.

    ``tensor`` is about the centre of mass, in axes that ``rotation`` maps to the axes of the link.
    """
    x, y, z = center
    # rotation maps the tensor's axes to the link's; None: they agree
    turned = tensor if rotation is None else _symmetric(rotate(tensor, rotation))
    return Inertial(element.get("name", ""), mass, (x, y, z), turned)


def _symmetric(tensor: Tensor) -> Tensor:
    return matrix([[(tensor[i][j] + tensor[j][i]) / 2 for j in range(3)] for i in range(3)])


def _tensor(entries: Mapping[str, Fraction]) -> Tensor:
    return matrix([[entries["i" + "".join(sorted(row + column))] for column in "xyz"] for row in "xyz"])


# --- formats ----------------------------------------------------------------------------------------------------------


def _read_urdf(element: Element, root: Element) -> Inertial:
    inertial = _inertial(element, "; the link has no mass")
    _require_known(inertial, (), ("origin", "mass", "inertia"))
    origin = _one(inertial, "origin", "inertial") if inertial.find("origin") is not None else None
    if origin is not None:
        _require_known(origin, ("xyz", "rpy"), ())
    center = _numbers("0 0 0" if origin is None else origin.get("xyz", "0 0 0"), 3, "origin.xyz")
    angles = _numbers("0 0 0" if origin is None else origin.get("rpy", "0 0 0"), 3, "origin.rpy")
    amount, inertia = (_one(inertial, tag, "inertial") for tag in ("mass", "inertia"))
    _require_known(amount, ("value",), ())
    _require_known(inertia, _ENTRIES, ())
    mass = _numbers(amount.get("value"), 1, "mass.value")[0]
    tensor = _tensor({key: _numbers(inertia.get(key), 1, f"inertia.{key}")[0] for key in _ENTRIES})
    return _body(element, mass, center, tensor, of_roll_pitch_yaw(angles, Angles()) if any(angles) else None)


def _read_sdf(element: Element, root: Element) -> Inertial:
    inertial = _inertial(element, "; SDF then assumes 1 kg and 1 kg m^2, which are not measured values")
    _require_known(inertial, ("auto",), ("pose", "mass", "inertia", "density", "fluid_added_mass"))
    if _flag(inertial.get("auto", "false"), "inertial.auto"):
        raise InputError("inertial: expected a mass and a tensor, got auto, which leaves both to the simulator")
    if inertial.find("fluid_added_mass") is not None:
        raise InputError("inertial: expected the inertia of a rigid body only, got the element fluid_added_mass")
    mass = _numbers(inertial.findtext("mass", "1"), 1, "mass")[0]
    for tag in ("pose", "mass", "inertia"):
        if inertial.find(tag) is not None:
            _one(inertial, tag, "inertial")
    inertia = inertial.find("inertia")
    if inertia is not None:
        _require_known(inertia, (), _ENTRIES)
    defaults = {key: "1" if key in ("ixx", "iyy", "izz") else "0" for key in _ENTRIES}
    entries = {
        key: _numbers(value if inertia is None else inertia.findtext(key, value), 1, f"inertia.{key}")[0]
        for key, value in defaults.items()
    }
    center, rotation = _pose(inertial.find("pose"))
    return _body(element, mass, center, _tensor(entries), rotation)


def _pose(pose: Element | None) -> tuple[tuple[Fraction, ...], Tensor | None]:
    """Return the position and the rotation matrix of an element <pose> of SDF.

    The matrix is None if all angles are zero. If ``pose`` is None, the position is zero and the matrix None.
    """
    if pose is None:
        return (Fraction(0),) * 3, None
    _require_known(pose, ("relative_to", "frame", "rotation_format", "degrees"), ())
    if pose.get("relative_to") or pose.get("frame"):
        raise InputError("pose: expected a pose in the frame of the link, got one relative to another frame")
    form = pose.get("rotation_format", "euler_rpy")
    if form == "quat_xyzw":
        *position, x, y, z, w = _numbers(pose.text, 7, "pose")
        return tuple(position), of_quaternion([w, x, y, z], Angles())
    if form != "euler_rpy":
        raise InputError(f"pose: expected the rotation_format euler_rpy or quat_xyzw, got {show(form)}")
    values = _numbers(pose.text or "0 0 0 0 0 0", 6, "pose")
    rotation = of_roll_pitch_yaw(values[3:], Angles(degrees=_flag(pose.get("degrees", "false"), "pose.degrees")))
    return values[:3], rotation if any(values[3:]) else None


_CHANGING = {
    "inertiafromgeom": ("auto", "false"), "balanceinertia": ("false",), "fusestatic": ("false",),
    "coordinate": ("local",), "boundmass": ("0",), "boundinertia": ("0",), "settotalmass": ("-1",),
}  # fmt: skip
"""Attribute of <compiler> that may make MuJoCo change inertials -> values for which MuJoCo leaves inertials unchanged.

For a numerical attribute these are all values that are not positive, of which one is listed.
"""


def _changes(key: str, text: str) -> bool:
    """Return whether MuJoCo changes inertials if an attribute of <compiler> has this value."""
    values = _CHANGING[key]
    if _NUMBER.fullmatch(values[0]):
        return _numbers(text, 1, f"compiler.{key}")[0] > 0
    return text not in values


def _read_mjcf(element: Element, root: Element) -> Inertial:
    inertial = _inertial(element, "; MuJoCo then computes the inertia from geoms, which is not read")
    if root.find(".//include") is not None:
        raise InputError(
            "expected a model in one file, got <include>, whose settings may change inertials; save the model as one "
            "file"
        )
    settings: dict[str, str] = {}
    for compiler in root.iter("compiler"):
        settings |= compiler.attrib
    for key, values in _CHANGING.items():
        if key in settings and _changes(key, settings[key]):
            raise InputError(
                f"compiler: expected {key} = {values[-1]!r}, got {show(settings[key])}, which makes MuJoCo "
                f'use other mass properties than those in <inertial>; write {key}="{values[-1]}", and copy the mass '
                "properties that MuJoCo uses into <inertial>"
            )
    sequence = settings.get("eulerseq", "xyz")
    if not re.fullmatch("[xyzXYZ]{3}", sequence):
        raise InputError(f"compiler.eulerseq: expected three axes such as 'xyz', got {show(sequence)}")
    unit = settings.get("angle", "degree")
    if unit not in ("degree", "radian"):
        raise InputError(f"compiler.angle: expected 'degree' or 'radian', got {show(unit)}")
    angles = Angles(unit == "degree", sequence)
    _require_known(inertial, ("pos", "mass", "diaginertia", "fullinertia", *ORIENTATIONS), ())
    mass = _numbers(inertial.get("mass"), 1, "inertial.mass")[0]
    center = _numbers(inertial.get("pos"), 3, "inertial.pos")
    ways = [key for key in ("diaginertia", "fullinertia") if inertial.get(key)]
    if len(ways) != 1:
        raise InputError(
            f"inertial: expected one of diaginertia and fullinertia, got {' and '.join(ways) or 'neither'}"
        )
    turns = [key for key in ORIENTATIONS if inertial.get(key)]
    if len(turns) > 1 or (turns and ways == ["fullinertia"]):
        raise InputError(
            "inertial: expected at most one orientation, and no orientation with fullinertia, got "
            f"{' and '.join(turns)}"
        )
    rotation = None
    for key in turns:
        count, rotation_of = ORIENTATIONS[key]
        rotation = rotation_of(_numbers(inertial.get(key), count, f"inertial.{key}"), angles)
    if ways == ["fullinertia"]:
        order = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
        entries = _numbers(inertial.get("fullinertia"), 6, "inertial.fullinertia")
        return _body(element, mass, center, _tensor(dict(zip(order, entries, strict=True))), None)
    moments = _numbers(inertial.get("diaginertia"), 3, "inertial.diaginertia")
    diagonal = matrix([[m * entry for entry in row] for m, row in zip(moments, IDENTITY, strict=True)])
    return _body(element, mass, center, diagonal, rotation)


FORMATS = {
    "robot": Format("URDF", "link", "link", _read_urdf),
    # the state of a world has the places of its links
    "sdf": Format("SDF", "link", ".//model/link", _read_sdf, ".//state//link"),
    "mujoco": Format("MJCF", "body", "worldbody//body", _read_mjcf),
}
"""Tag of the XML root element of a robot file -> format of the file."""
