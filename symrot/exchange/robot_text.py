"""Writing of a link's inertial to a robot file: XML text with principal axes and a diagonal tensor replaces the old."""

from collections.abc import Callable
from fractions import Fraction
from math import nextafter
from pathlib import Path
from xml.etree import ElementTree

from symrot.errors import InputError
from symrot.exchange.inertial import Inertial
from symrot.exchange.orientation import quaternion_of, roll_pitch_yaw_of
from symrot.exchange.robot import Format, read_robot
from symrot.exchange.xml_file import Span, span_of
from symrot.files.paths import path_of
from symrot.files.writing import write
from symrot.formula.exact_numbers import show
from symrot.inertia.principal import Principal

__all__ = ["inertial_text", "write_link"]

ROUNDING = Fraction(1, 10**14)
"""Largest difference of a mass property that was written and read back.

It is relative to the mass, the largest coordinate of the centre of mass, or the largest entry of the tensor."""


def write_link(source: str | Path, name: str, inertial: Inertial, target: str | Path | None = None) -> Path:
    """Replace the inertial of a link in a robot file by its principal form: principal axes and a diagonal tensor.

    Parameters
    ----------
    source : str or Path
        A file in the format URDF, MJCF or SDF.
    name : str
        Name of the link (in MJCF: of the body), as :func:`symrot.links` returns it.
    inertial : Inertial
        From :func:`symrot.mesh`, :func:`symrot.link` or a formula, in the axes of the link.
    target : str or Path, optional
        The file to write; default: ``source``.

    Returns
    -------
    Path
        The file that was written.

    Raises
    ------
    InputError
        If ``source`` is no robot file in UTF-8, if there is not exactly one link of this name, if other parts of the
        file would change the new values, or if the file cannot be written.

    Examples
    --------
    >>> import symrot
    >>> symrot.write_link("robot.urdf", "upper_arm", symrot.mesh("arm.stl", mass=2), "new.urdf")  # doctest: +SKIP
    """
    form, root, content = read_robot(source)
    path = path_of(source if target is None else target, "target")
    same = [element for each, element in form.links(root) if each == name]
    if len(same) != 1:
        raise InputError(f"{source}: expected one link of the name {show(name)}, got {len(same) or 'none'}")
    if not _is_utf8(content):
        raise InputError(f"{source}: expected a file in UTF-8, got another encoding; save it as UTF-8")
    span, present = span_of(content, form.tag, [*root.iter(form.tag)].index(same[0]), "inertial")
    text = inertial_text(inertial, form.name)
    if not present and content[: span.start].endswith(b"/>"):  # <link name=".."/>
        span, text = Span(span.start - 2, span.stop), f">\n    {text}\n  </{form.tag}>"
    elif not present:
        text = f"\n    {text}"
    result = content[: span.start] + text.encode("utf-8") + content[span.stop :]
    _require_same(form, result, name, inertial, str(source))
    write(path, lambda stream: stream.write(result))
    return path


def _require_same(form: Format, result: bytes, name: str, inertial: Inertial, where: str) -> None:
    """Raise InputError unless the new file ``result``, not yet written, gives the mass properties of ``inertial``."""
    root = ElementTree.fromstring(result)
    element = dict(form.links(root))[name]
    try:
        again = form.read(element, root)
    except InputError as reason:
        raise InputError(f"{where}: link {show(name)}: {reason}") from None
    largest = max(abs(entry) for row in inertial.inertia for entry in row)
    size = max(map(abs, inertial.center_of_mass))
    pairs = [
        (inertial.mass, again.mass, inertial.mass),
        *((x, y, size) for x, y in zip(inertial.center_of_mass, again.center_of_mass, strict=True)),
        *(
            (x, y, largest)
            for row, other in zip(inertial.inertia, again.inertia, strict=True)
            for x, y in zip(row, other, strict=True)
        ),
    ]
    if any(abs(x - y) > scale * ROUNDING for x, y, scale in pairs):
        raise InputError(
            f"{where}: link {show(name)}: the new <inertial> would be read with values other than those computed, "
            "because other parts of the file change it; no file was written"
        )


def _is_utf8(content: bytes) -> bool:
    head = content[:200].lower()
    declares_other = b"encoding" in head and b"utf-8" not in head and b"us-ascii" not in head
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return False
    return not declares_other and b"\0" not in content


def inertial_text(inertial: Inertial, form: str) -> str:
    """Return the XML element ``<inertial>`` of a link, with principal axes and a diagonal tensor.

    Parameters
    ----------
    inertial : Inertial
        Mass, centre and tensor.
    form : str
        ``"URDF"``, ``"MJCF"`` or ``"SDF"``.

    Raises
    ------
    InputError
        If the format is unknown.

    Examples
    --------
    >>> from fractions import Fraction
    >>> body = Inertial("ball", Fraction(2), (0, 0, 1), ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
    >>> inertial_text(body, "MJCF")
    '<inertial pos="0 0 1" mass="2" quat="1 0 0 0" diaginertia="1 1 1"/>'
    """
    if form not in _WRITERS:
        raise InputError(f"expected a format, one of {', '.join(_WRITERS)}, got {show(form)}")
    return _WRITERS[form](inertial)


def _digits(*values: object) -> str:
    """Return numbers as text, from which the same doubles are read."""
    return " ".join(repr(float(value)).removesuffix(".0") for value in values)  # type: ignore[arg-type]


def _moments(principal: Principal) -> list[str]:
    """Return the principal moments as text, rounded so that the moments of a flat body still satisfy A + B >= C."""
    moments = [float(moment) for moment in principal.moments]
    largest = max(range(3), key=moments.__getitem__)
    while sum(Fraction(repr(m)) for m in moments) < 2 * Fraction(repr(moments[largest])):
        moments[largest] = nextafter(moments[largest], 0)
    return [_digits(moment) for moment in moments]


def _urdf(inertial: Inertial) -> str:
    principal = inertial.principal
    a, b, c = _moments(principal)
    return (
        f'<inertial>\n      <origin xyz="{_digits(*inertial.center_of_mass)}" '
        f'rpy="{_digits(*roll_pitch_yaw_of(principal.axes))}"/>\n'
        f'      <mass value="{_digits(inertial.mass)}"/>\n'
        f'      <inertia ixx="{a}" ixy="0" ixz="0" iyy="{b}" iyz="0" izz="{c}"/>\n    </inertial>'
    )


def _mjcf(inertial: Inertial) -> str:
    principal = inertial.principal
    moments = " ".join(_moments(principal))
    return (
        f'<inertial pos="{_digits(*inertial.center_of_mass)}" mass="{_digits(inertial.mass)}" '
        f'quat="{_digits(*quaternion_of(principal.axes))}" diaginertia="{moments}"/>'
    )


def _sdf(inertial: Inertial) -> str:
    principal = inertial.principal
    a, b, c = _moments(principal)
    pose = _digits(*inertial.center_of_mass, *roll_pitch_yaw_of(principal.axes))
    return (
        f"<inertial>\n      <pose>{pose}</pose>\n      <mass>{_digits(inertial.mass)}</mass>\n"
        f"      <inertia><ixx>{a}</ixx><ixy>0</ixy><ixz>0</ixz><iyy>{b}</iyy><iyz>0</iyz><izz>{c}</izz></inertia>\n"
        "    </inertial>"
    )


_WRITERS: dict[str, Callable[[Inertial], str]] = {"URDF": _urdf, "MJCF": _mjcf, "SDF": _sdf}
