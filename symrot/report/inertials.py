"""Reports on the mass properties of bodies that were read from meshes and robot files, as text and as data."""

from collections.abc import Sequence
from typing import Any

from symrot.exchange.inertial import Inertial
from symrot.exchange.orientation import quaternion_of
from symrot.exchange.robot import Link
from symrot.report.layout import fields
from symrot.scene.content import toml_text

__all__ = ["facts", "lines", "link_facts", "link_lines", "table_text"]


def facts(inertial: Inertial) -> dict[str, Any]:
    """Return the mass properties of a body as data for JSON: mass, centre of mass, inertia, .."""
    principal = inertial.principal
    return {
        "name": inertial.name,
        "mass": float(inertial.mass),
        "center_of_mass": [float(x) for x in inertial.center_of_mass],
        "inertia": [[float(entry) for entry in row] for row in inertial.inertia],
        "principal": {
            "moments": [float(moment) for moment in principal.moments],
            "quaternion": list(quaternion_of(principal.axes)),
            "kind": principal.kind,
        },
        "volume": None if inertial.volume is None else float(inertial.volume),
        "error": inertial.error,
        "checks": inertial.checks,
    }


def lines(inertial: Inertial) -> list[str]:
    """Return lines of text with the mass properties of a body, in the axes of its file."""
    table = facts(inertial)
    rows = [
        ("mass", f"{table['mass']:.15g} kg"),
        ("centre of mass", f"{_numbers(table['center_of_mass'])} m"),
        *zip(("inertia", "", ""), (f"{_numbers(row)} kg m^2" for row in table["inertia"]), strict=True),
        ("principal moments", f"{_numbers(table['principal']['moments'])} kg m^2, {table['principal']['kind']}"),
        ("principal axes", f"{_numbers(table['principal']['quaternion'])} (quaternion, scalar first)"),
    ]
    if table["volume"] is not None:
        rows.append(("volume", f"{table['volume']:.15g} m^3"))
        rows.append(
            ("error", f"at most {table['error']:.1e}, relative" if table["error"] else "none: exact arithmetic")
        )
        rows.append(("surface", table["checks"]))
    return [f"{inertial.name}, about its centre of mass", *fields((f"  {name}", text) for name, text in rows)]


def table_text(inertial: Inertial, fixed_point: str | None = None) -> str:
    """Return the table ``[body]`` of a scene file as TOML, about the centre of mass or a fixed point ``"X,Y,Z"``, m."""
    return toml_text({"body": dict(inertial.table(None if fixed_point is None else fixed_point.split(",")))})


def _numbers(values: Sequence[float]) -> str:
    return "  ".join(f"{value + 0.0:.15g}" for value in values)


def link_facts(link: Link) -> dict[str, Any]:
    """Return data for JSON about one link (rigid part) of a robot: mass properties, or the reason why it has none."""
    body = {} if link.inertial is None else facts(link.inertial)
    return {"name": link.name, "problem": link.problem, **body}


def link_lines(links: Sequence[Link]) -> list[str]:
    """Return one line of text for each link (rigid part) of a robot: its mass properties, or why it has none."""
    width = max(len(link.name) for link in links)
    return [f"{link.name:{width}}  {_summary(link)}" for link in links]


def _summary(link: Link) -> str:
    if link.inertial is None:
        return "no inertial" if link.empty else link.problem
    moments = _numbers([float(moment) for moment in link.inertial.principal.moments])
    return f"{float(link.inertial.mass):.15g} kg, principal moments {moments} kg m^2"
