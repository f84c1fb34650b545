"""The public function ``show``, which writes a motion as a page or a film, and its picture in a notebook."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from html import escape
from pathlib import Path

import numpy as np

from symrot.ensemble.ensemble import EnsembleMember
from symrot.errors import InputError
from symrot.files.paths import path_of
from symrot.files.writing import check_target, write
from symrot.propagation.propagate import propagator
from symrot.propagation.trajectory import Trajectory
from symrot.results.samples import MotionSamples
from symrot.scene.scene import Scene, SceneSource, load_scene
from symrot.scene.tables import Initial
from symrot.viewer import film
from symrot.viewer.model import with_attitude
from symrot.viewer.page import page

__all__ = ["PAGES", "in_frame", "show"]

PAGES = (".html", ".htm")


def show(
    motion: SceneSource | Trajectory | EnsembleMember,
    path: str | Path | None = None,
    progress: Callable[[int, int], object] = lambda done, all: None,
) -> Path:
    """Write a motion as one offline HTML page that computes and plays it, or as a film.

    Readers can change the motion in the page if it is computed there.

    Parameters
    ----------
    motion : Scene, Trajectory, EnsembleMember, str or Path
        A scene, the name of a shipped scene, the path of a scene file, a trajectory, or a motion of an ensemble. A page
        made from a trajectory or a motion starts with its initial state and covers its span.
    path : str or Path, optional
        The file to write: ``.html``, or ``.gif`` or ``.mp4`` for a film, which needs ``symrot[film]``. The default is a
        page with the name of the scene in the current folder.
    progress : function
        Called for a film, with the number of frames drawn so far and the number of all frames.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        For a scene that cannot be used, a file that cannot be written, or an encoder that is not installed.
    PropagationError
        For a motion that symrot cannot follow to its end.

    Notes
    -----
    A motion under torques that have jumps, kinks, possible short pulses or no formula is computed by symrot beforehand;
    the page plays it.

    Examples
    --------
    >>> import symrot, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     symrot.show("t_handle", f"{folder}/t_handle.html").name
    't_handle.html'
    """
    scene, trajectory = _scene_and_motion(motion)
    target = path_of(path, "show") if path is not None else Path(f"{scene.name}{PAGES[0]}")
    check_target(target, (*PAGES, *film.SUFFIXES), "show")
    if target.suffix.lower() in film.SUFFIXES:
        film.require_encoder(target)
        film.write_film(trajectory or propagator(with_attitude(scene))(), target, progress)
        return target
    text = page(scene, trajectory)
    write(target, lambda stream: stream.write(text.encode("utf-8")))
    return target


def in_frame(trajectory: MotionSamples) -> str:
    """Return the HTML that shows one motion in a notebook: an ``iframe`` that holds its whole page."""
    text = escape(page(*_scene_and_motion(trajectory)), quote=True)
    return f'<iframe srcdoc="{text}" style="width:100%;height:760px;border:0" title="motion"></iframe>'


def _state_at(scene: Scene, time: Fraction) -> Initial:
    """Return omega and quaternion of a scene's motion at a time, s, for a page whose motion starts then."""
    state = propagator(with_attitude(scene))([float(time)])
    first, second, third = map(Fraction, state.omega[0].tolist())
    a, b, c, d = map(Fraction, state.quaternion[0].tolist())
    return Initial((first, second, third), (a, b, c, d))


def _scene_and_motion(motion: SceneSource | MotionSamples) -> tuple[Scene, Trajectory | None]:
    """Return the scene of a page, and the trajectory that the page plays, or None if it computes the motion."""
    if isinstance(motion, MotionSamples):
        if motion.omega.ndim != 2:
            raise InputError("show: expected one motion, got an ensemble; show one of its motions: ensemble[0].show()")
        times = motion.t[np.isfinite(motion.omega).all(axis=1)]  # s, those that the motion reached
        if not len(times):
            raise InputError("show: expected a motion with samples, got one that reached none of its sample times")
        start, stop = (Fraction(float(time)) for time in (times.min(), times.max()))
        if start == stop:
            raise InputError(f"show: expected a trajectory over a span of time, got the single time {float(start)!r} s")
        scene = motion.scene
        played = motion if isinstance(motion, Trajectory) and motion.has_external_torque else None
        if start != scene.span.start and played is None:
            scene = replace(scene, initial=_state_at(scene, start))
        scene = replace(scene, span=scene.span._replace(start=start, stop=stop))
        # a page cannot compute a torque without a formula (a Python function)
        return scene, played
    return load_scene(motion), None
