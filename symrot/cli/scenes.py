"""The options of every command that takes a scene: its name or file, ``--set`` and ``--table-folder``."""

from argparse import ArgumentParser, Namespace

import symrot
from symrot.scene.settings import SET_HELP, settings

__all__ = ["load", "scene_options"]


def scene_options(parser: ArgumentParser) -> None:
    """Declare the arguments of a command that takes a scene: the scene, ``--set`` and ``--table-folder``."""
    parser.add_argument("scene", metavar="SCENE", help="a shipped scene (see `symrot scenes`), or a file")
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], dest="settings", help=SET_HELP)
    parser.add_argument("--table-folder", metavar="DIR", action="append", default=[],
                        help="let the scene read files of samples in this folder too; may be repeated "
                        "(default: only the scene's own folder)")  # fmt: skip


def load(options: Namespace) -> "symrot.Scene":
    """Return the scene that a command's options name, with the values of ``--set`` in place of those in its file."""
    scene = symrot.load_scene(options.scene, table_folders=options.table_folder)
    return scene.with_(settings(options.settings)) if options.settings else scene
