"""The HTML text of a page: one file that contains its script, style and numbers, and needs no network."""

import json
import re
from functools import cache
from html import escape
from pathlib import Path

from symrot import __version__
from symrot.propagation.trajectory import Trajectory
from symrot.scene.scene import Scene
from symrot.viewer.model import page_model

__all__ = ["page"]

FOLDER = Path(__file__).with_name("assets")
SCRIPTS = ("motion.js", "model.js", "drawing.js", "panels.js", "page.js")
STYLES = ("uplot.css", "page.css")
LIBRARIES = "libraries.js"


def page(scene: Scene, trajectory: Trajectory | None = None) -> str:
    """Return the HTML text of a page that shows the motion of a scene.

    The same scene gives the same bytes.

    Parameters
    ----------
    scene : Scene
        The scene.
    trajectory : Trajectory, optional
        A motion for the page to play. Without it, the page's script computes the scene's own motion in the browser. If
        a torque has samples, jumps, kinks, or a formula that may have short pulses, symrot computes the motion
        beforehand, and the page plays it.

    Raises
    ------
    InputError, PropagationError
        As for :func:`symrot.propagate`.

    Examples
    --------
    >>> import symrot
    >>> "<canvas" in page(symrot.load_scene("t_handle"))
    True
    """
    model = page_model(scene, trajectory)
    parts = {
        "version": __version__,
        "title": escape(scene.title or scene.name),
        "command": escape(model.data["command"]),
        "style": "\n".join(_text(name) for name in STYLES),
        "data": _in_script(json.dumps(model.data, separators=(",", ":"))),
        "libraries": _text(LIBRARIES),
        "kernel": model.kernel,
        "scripts": "\n".join(_without_modules(_text(name)) for name in SCRIPTS),
    }
    return re.sub(r"\{(\w+)\}", lambda match: parts[match[1]], _text("page.html"))


@cache
def _text(name: str) -> str:
    return (FOLDER / name).read_text(encoding="utf-8")


def _in_script(text: str) -> str:
    """Return JSON text with ``<`` escaped, so that a title in it cannot end the surrounding HTML script element."""
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def _without_modules(text: str) -> str:
    """Return a JavaScript module without ``export``, so that several modules can share one script element."""
    return re.sub(r"^export (?=class|const|function)", "", text, flags=re.MULTILINE)
