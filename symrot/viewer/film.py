"""Films of a motion as GIF or MP4: matplotlib draws the frames, Pillow or ffmpeg encodes them."""

from collections.abc import Callable, Iterator
from importlib.util import find_spec
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
from symrot.files.writing import write
from symrot.kinematics.conversions import quaternion_to_dcm
from symrot.propagation.trajectory import Trajectory
from symrot.viewer.body_surface import Patch, Point, patches

__all__ = ["SUFFIXES", "require_encoder", "write_film"]

Floats = NDArray[np.float64]

SUFFIXES = (".gif", ".mp4")
RATE = 20  # frames per second
LONGEST = 8.0  # s, duration of a film
FASTEST = 1.5 * pi  # rad/s, rotation in the film, unless the film would be longer than LONGEST
TRAIL_POINTS, PER_STEP, MOST_POINTS = 1500, 12, 20000  # of the path of the body's axis
MOST_FLAT = 60
LONGEST_TITLE = 60
SIZE = 5.0  # inches at 100 dots per inch
REACH = 1.75  # half the width of the picture, relative to the size of the body
LOWER = 0.6  # how far below the origin the axes x and y reach on the screen, as a height
CLOSE = 0.35  # distance of the tips of two arrows
TIP = 1.35  # length of the drawn axis of the body
BODY, EDGE, AXES, OMEGA, MOMENTUM, TRAIL = "#7fa6cf", "#24364a", "#6b7684", "#d55e00", "#0060b0", "#008a63"
VIEW = {"elev": 22.0, "azim": -52.0}


def require_encoder(path: Path) -> None:
    """Raise InputError if a package needed to write a film to ``path``, such as matplotlib, is not installed."""
    if find_spec("matplotlib") is None:
        raise InputError(
            f"{path}: expected matplotlib, but it is not installed; install it with pip install 'symrot[film]'"
        )
    if path.suffix.lower() == ".mp4" and find_spec("imageio_ffmpeg") is None:
        raise InputError(
            f"{path}: expected imageio-ffmpeg, but it is not installed; install it with pip install 'symrot[film]'"
        )


def write_film(
    trajectory: Trajectory, path: Path, progress: Callable[[int, int], object] = lambda done, all: None
) -> None:
    """Write a film of a trajectory's motion to a GIF or MP4 file.

    Parameters
    ----------
    trajectory : Trajectory
        A motion with attitude. Frames are taken from its dense solution, not from its samples.
    path : Path
        ``.gif`` or ``.mp4``.
    progress : function
        Called with the number of frames drawn so far and the number of all frames.

    Raises
    ------
    InputError
        If the encoder is not installed, the trajectory has no attitude, or the GIF file cannot be written.
    """
    require_encoder(path)
    times = _times(trajectory)

    def frames() -> Iterator[Floats]:
        for number, frame in enumerate(_frames(trajectory, times), start=1):
            progress(number, len(times))
            yield frame

    if path.suffix.lower() == ".gif":
        write(path, lambda stream: _gif(frames(), stream))
    else:
        _mp4(frames(), path)


def _times(trajectory: Trajectory) -> Floats:
    """Return the times of the frames of a film, evenly spaced over the whole motion.

    The film lasts longer for a faster body, within limits.
    """
    start, stop = float(trajectory.t.min()), float(trajectory.t.max())
    fastest = float(np.max(np.linalg.norm(trajectory.omega, axis=1)))
    duration = min(max(fastest * (stop - start) / FASTEST, 2.0), LONGEST)
    return np.linspace(start, stop, round(duration * RATE))


def _clock(time: float, last: float) -> str:
    """Return the time as a frame shows it: ``_clock(1.5, 12.0)`` is ``"t = 1.50 s"``.

    All frames up to the time ``last`` have the same decimals, so that the digits do not jump.
    """
    decimals = max(3 - int(np.floor(np.log10(max(abs(last), 1e-12)))), 0)
    return f"t = {time:.{decimals}f} s"


def _frames(trajectory: Trajectory, times: Floats) -> Iterator[Floats]:
    """Yield the frame for each of ``times`` as an array of pixels, shape (height, width, 3), 8 bits per colour."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    scene = trajectory.scene
    surface = patches(scene.body)
    size = max((float(np.max(np.linalg.norm(patch.points, axis=1))) for patch in surface), default=1.0) or 1.0
    principal = scene.body.principal
    axis = np.array(principal.axes, dtype=float)[:, 2 if principal.symmetry_axis is None else principal.symmetry_axis]
    inertia = np.array(scene.body.inertia, dtype=float)
    rotors = [torque.vector("angular_momentum") for torque in scene.torques if torque.kind == "rotor"]
    rotor = np.sum(np.array(rotors, dtype=float).reshape(-1, 3), axis=0)
    points = min(max(TRAIL_POINTS, PER_STEP * trajectory.stats.accepted), MOST_POINTS)
    path = quaternion_to_dcm(_attitudes(trajectory, np.linspace(times[0], times[-1], points))) @ axis * TIP
    omegas = trajectory.sol(times).T[:, :3]
    dcms = quaternion_to_dcm(_attitudes(trajectory, times))
    scales = [1.5 / max(float(np.max(np.linalg.norm(v, axis=1))), 1e-300) for v in (omegas, omegas @ inertia + rotor)]
    faces = [(patch, _polygons(patch)) for patch in surface]
    polygons = [face / size for _, of_patch in faces for face in of_patch]
    shades = [_shade(patch, place) for patch, of_patch in faces for place in range(len(of_patch))]
    curves = [np.array(part) / size for patch in surface if patch.rows == 1 for part in _curves(patch)]
    middle = _middle(np.concatenate([np.zeros((1, 3)), *polygons, *curves]), dcms, path)
    figure = Figure(figsize=(SIZE, SIZE), dpi=100)
    canvas = FigureCanvasAgg(figure)
    for number, (time, dcm, omega) in enumerate(zip(times, dcms, omegas, strict=True)):
        figure.clear()
        axes: Any = figure.add_axes((0, 0, 1, 1), projection="3d", computed_zorder=False)
        _draw(axes, [face @ dcm.T for face in polygons], shades, path, number / max(len(times) - 1, 1), middle)
        for points_of_curve in curves:
            style = {"marker": "o", "linestyle": ""} if len(points_of_curve) < 2 else {"linewidth": 4}
            axes.plot(*(points_of_curve @ dcm.T).T, color=BODY, zorder=2, **style)
        rate, momentum = dcm @ omega * scales[0], dcm @ (inertia @ omega + rotor) * scales[1]
        is_close = bool(np.linalg.norm(rate - momentum) < CLOSE)  # the two labels would cover each other
        far = max(np.linalg.norm(rate), np.linalg.norm(momentum))
        for vector, colour, name, side in ((rate, OMEGA, "\u03c9 ", "right"), (momentum, MOMENTUM, " L", "left")):
            axes.quiver(0, 0, 0, *vector, color=colour, linewidth=2, arrow_length_ratio=0.1, zorder=5)
            # beside each other at the farther tip, if the tips are close
            place = 1.1 * far * vector / max(np.linalg.norm(vector), 1e-300) if is_close else 1.1 * vector
            label = {"color": colour, "fontsize": 13, "fontstyle": "italic", "zorder": 6}
            axes.text(*place, name if is_close else name.strip(), ha=side if is_close else "center", **label)
        title = scene.title if len(scene.title) <= LONGEST_TITLE else f"{scene.title[: LONGEST_TITLE - 2]} .."
        figure.text(0.02, 0.95, title, fontsize=11, color=EDGE, parse_math=False)
        figure.text(0.02, 0.03, _clock(time, times[-1]), fontsize=11, color=EDGE)
        canvas.draw()
        yield np.asarray(canvas.buffer_rgba())[:, :, :3].copy()


def _attitudes(trajectory: Trajectory, times: Floats) -> Floats:
    states = trajectory.sol(times).T
    if states.shape[1] != 7:
        raise InputError('show: expected a trajectory with attitude; add "quaternion" to output.quantities')
    quaternions: Floats = states[:, 3:] / np.linalg.norm(states[:, 3:], axis=1, keepdims=True)
    return quaternions


def _middle(body: Floats, dcms: Floats, path: Floats) -> float:
    """Return the height z of the middle of the picture, relative to the size of the body.

    The height is positive if neither the body nor the path of its axis comes far below the origin, as for a top that
    stands on the origin; otherwise it is 0, the height of the origin. ``body`` are points of the body, shape (n, 3),
    ``dcms`` its attitudes, and ``path`` the path of its axis.
    """
    lowest = min(float((dcms[:, 2, :] @ body.T).min()), float(path[:, 2].min()))
    # the axes x and y end lower on the screen than the origin
    return max(0.0, (REACH + lowest - LOWER) / 2)


def _draw(axes: Any, polygons: list[Floats], shades: list[float], path: Floats, elapsed: float, middle: float) -> None:
    """Draw one frame: the body, the axes of space, and the path of the body's axis.

    ``polygons`` are the faces of the body in space, and ``shades`` are their brightnesses, 0 to 1. ``elapsed`` is the
    fraction of the film's time up to this frame: the path is drawn dark up to this time, and pale after it. ``middle``
    is the height of the middle of the picture.
    """
    from matplotlib.colors import to_rgb
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    axes.set(xlim=(-REACH, REACH), ylim=(-REACH, REACH), zlim=(middle - REACH, middle + REACH))
    axes.set_box_aspect((1, 1, 1), zoom=1.3)
    axes.view_init(**VIEW)
    axes.set_axis_off()
    for k, name in enumerate("xyz"):
        end = np.zeros(3)
        end[k] = REACH
        axes.plot(*np.array([np.zeros(3), end]).T, color=AXES, linewidth=1, zorder=1)
        axes.text(*(1.06 * end), name, color=AXES, fontsize=12, fontstyle="italic")
    colours = [tuple(shade * c for c in to_rgb(BODY)) for shade in shades]
    edges = EDGE if len(polygons) <= MOST_FLAT else colours  # a body of a few flat faces shows its edges
    axes.add_collection3d(Poly3DCollection(polygons, facecolors=colours, edgecolors=edges, linewidths=0.6, zorder=2))
    axes.plot(*path.T, color=TRAIL, alpha=0.3, linewidth=1, zorder=3)
    axes.plot(*path[: max(2, round(elapsed * len(path)))].T, color=TRAIL, linewidth=1.6, zorder=4)


def _polygons(patch: Patch) -> list[Floats]:
    """Return the polygons of a patch of the body's surface as arrays of corners; curves, points and holes have none."""
    if patch.is_mesh:
        return list(np.array(patch.points).reshape(-1, 3, 3))
    if patch.rows < 2 or patch.is_hole:
        return []
    grid = np.array(patch.points).reshape(patch.rows, patch.columns, 3)
    return [
        np.array([grid[i, j], grid[i, j + 1], grid[i + 1, j + 1], grid[i + 1, j]])
        for i in range(patch.rows - 1)
        for j in range(patch.columns - 1)
    ]


def _curves(patch: Patch) -> list[list[Point]]:
    """Return the points of a curve as one list, or of separate points as one list each; both are patches without area.

    A patch is a part of the body's drawing: a surface, a curve or separate points.
    """
    return [patch.points] if patch.columns else [[point] for point in patch.points]


def _shade(patch: Patch, place: int) -> float:
    """Return the brightness, 0 to 1, of polygon number ``place`` of a patch of the body's surface."""
    if patch.is_mesh:
        x, y, _ = np.array(patch.points[3 * place : 3 * place + 3]).mean(axis=0)
        return 0.72 if x * y < 0 else 0.95
    # Neighbouring quarters of a round surface differ, so that its rotation can be seen.
    across = max(patch.columns, patch.rows) - 1
    column = place % (patch.columns - 1) if patch.columns > 2 else place // max(patch.columns - 1, 1)
    return 0.72 if int(4 * column / max(across, 1)) % 2 else 0.95


def _gif(frames: Iterator[Floats], stream: Any) -> None:
    from PIL import Image

    first, *others = (Image.fromarray(frame).quantize(128, dither=Image.Dither.NONE) for frame in frames)
    first.save(stream, format="GIF", save_all=True, append_images=others, duration=1000 // RATE, loop=0, optimize=True)


def _mp4(frames: Iterator[Floats], path: Path) -> None:
    import imageio_ffmpeg

    first = next(frames)
    height, width, _ = first.shape
    writer = imageio_ffmpeg.write_frames(str(path), (width, height), fps=RATE, macro_block_size=2)
    writer.send(None)
    writer.send(np.ascontiguousarray(first))
    for frame in frames:
        writer.send(np.ascontiguousarray(frame))
    writer.close()
