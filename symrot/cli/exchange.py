"""The command ``symrot inertia``, which reads bodies from meshes and robot files of other programs."""

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING

from symrot.cli.output import FAILED, OK, Command, json_option, say, say_json
from symrot.errors import InputError

if TYPE_CHECKING:
    from symrot.exchange.inertial import Inertial

__all__ = ["COMMANDS"]


def _inertia(options: Namespace) -> int:
    from symrot.exchange import robot
    from symrot.exchange.mesh import mesh
    from symrot.exchange.mesh_file import SUFFIXES
    from symrot.report import inertials

    if options.json and options.toml:
        raise InputError("inertia: expected at most one of --json and --toml")
    if options.fixed_point is not None and not options.toml:
        raise InputError("--fixed-point: expected --toml as well")
    path, name = _path_and_link(options.file)
    of_mesh = {key: getattr(options, key) for key in ("mass", "density", "scale") if getattr(options, key) is not None}
    if Path(path).suffix.lower() in SUFFIXES:
        if name:
            raise InputError(
                f"{options.file}: expected the path of a mesh alone, got {name!r} after it; only robot files have links"
            )
        return _print(mesh(path, **of_mesh, flip=options.flip), options)
    if of_mesh or options.flip:
        raise InputError(f"{path}: expected a mesh ({', '.join(SUFFIXES)}) for --mass, --density, --scale and --flip")
    if not name and not options.toml:
        every = robot.links(path)
        if len(every) > 1:
            if options.json:
                say_json([inertials.link_facts(each) for each in every])
            else:
                say(inertials.link_lines(every))
            return FAILED if any(each.problem and not each.empty for each in every) else OK
    return _print(robot.link(path, name), options)


def _path_and_link(text: str) -> tuple[str, str]:
    """Return the path and the name of the link in the text ``FILE:LINK``; the name may be missing.

    Both may contain colons. The path is the longest beginning of the text, up to a colon, that names a file; if there
    is no such file, the text before the last colon.
    """
    ends = [len(text), *(place for place in range(len(text) - 1, 0, -1) if text[place] == ":")]
    end = next((end for end in ends if Path(text[:end]).is_file()), ends[min(1, len(ends) - 1)])
    return text[:end], text[end + 1 :]


def _print(inertial: "Inertial", options: Namespace) -> int:
    from symrot.report import inertials

    if options.json:
        say_json(inertials.facts(inertial))
    elif options.toml:
        say(inertials.table_text(inertial, options.fixed_point).splitlines())
    else:
        say(inertials.lines(inertial))
    return OK


def _inertia_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "file", metavar="FILE[:LINK]", help="a mesh (STL, OBJ, PLY, GLB), or a robot (URDF, MJCF, SDF) and its link"
    )
    parser.add_argument("--mass", metavar="X", help="mass of a mesh, kg")
    parser.add_argument("--density", metavar="X", help="density of a mesh, kg/m^3: a number or a polynomial in x, y, z")
    parser.add_argument("--scale", metavar="X", help="unit of length of a mesh in m: 1/1000 for mm (default: 1)")
    parser.add_argument("--flip", action="store_true", help="reverse the triangles of a mesh that is turned inside out")
    parser.add_argument("--toml", action="store_true", help="print the table [body] of a scene")
    parser.add_argument("--fixed-point", metavar="X,Y,Z", help="with --toml: the point of the file, m, about which the "
                        "body rotates (default: its centre of mass)")  # fmt: skip
    json_option(parser)


COMMANDS: dict[str, Command] = {
    "inertia": ("print the inertia of a mesh or of a robot's link", _inertia, _inertia_arguments),
}
"""Name of the command -> (help text, function that runs it, function that declares its arguments)."""
