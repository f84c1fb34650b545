"""The public function ``show``, which writes a motion as a page, and the picture of a motion in a notebook."""

from dataclasses import replace
from fractions import Fraction
from html import escape
from pathlib import Path

from symrot.files.writing import check_target, write
from symrot.propagation.trajectory import Trajectory
from symrot.scene.scene import Scene, load_scene
from symrot.viewer.page import page

__all__ = ["SUFFIXES", "in_notebook", "show"]

SUFFIXES = (".html", ".htm")


def show(motion: Scene | Trajectory | str | Path, path: str | Path | None = None) -> Path:
    """Write a motion as one offline page of HTML that computes it, plays it and lets the reader change it.

    Parameters
    ----------
    motion : Scene, Trajectory, str or Path
        A scene, the name of a shipped scene, the path of a scene file, or a trajectory. Of a trajectory, the page shows
        its initial state and its span.
    path : str or Path, optional
        The file to write, ``.html``; the default is the name of the scene in the current folder.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        For a scene that cannot be used, or a file that cannot be written.
    PropagationError
        For a motion that symrot cannot follow to its end.

    Notes
    -----
    A motion with torques that jump, or that have no closed formula, is computed by symrot beforehand and played.

    Examples
    --------
    >>> import symrot, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     symrot.show("t_handle", f"{folder}/t_handle.html").name
    't_handle.html'
    """
    scene, trajectory = _scene_and_motion(motion)
    target = Path(path) if path is not None else Path(f"{scene.name}{SUFFIXES[0]}")
    check_target(target, SUFFIXES, "show")
    text = page(scene, trajectory)
    write(target, lambda stream: stream.write(text.encode("utf-8")))
    return target


def in_notebook(trajectory: Trajectory) -> str:
    """Return the HTML that shows a trajectory in a notebook: its page, in a frame of its own."""
    text = escape(page(*_scene_and_motion(trajectory)), quote=True)
    return f'<iframe srcdoc="{text}" style="width:100%;height:760px;border:0" title="motion"></iframe>'


def _scene_and_motion(motion: Scene | Trajectory | str | Path) -> tuple[Scene, Trajectory | None]:
    """Return the scene of a page, and the trajectory if the page must play it because its torque has no formula."""
    if isinstance(motion, Trajectory):
        start, stop = (Fraction(float(time)) for time in (motion.t.min(), motion.t.max()))
        scene = replace(motion.scene, span=motion.scene.span._replace(start=start, stop=stop))
        return scene, motion if motion.has_external_torque else None
    return (motion if isinstance(motion, Scene) else load_scene(motion)), None
