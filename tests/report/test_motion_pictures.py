"""Pictures of motions: samples as dense as the motion needs, angles to the vertical, and paths that fill their panel."""

import numpy as np
import pytest

import symrot

pytest.importorskip("matplotlib")

from matplotlib import rc_context
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from symrot.report import plot, sphere
from symrot.report.picture import STYLE
from symrot.report.vertical import has_vertical, local_vertical, vertical_angles


def rotation_between_samples(motion):
    """Return the largest angle between the attitudes of consecutive samples, rad."""
    cosines = np.abs(np.sum(motion.quaternion[1:] * motion.quaternion[:-1], axis=1))
    return 2 * np.arccos(np.minimum(cosines.min(), 1.0))


@pytest.mark.parametrize("scene", ["earth_wobble", "heavy_top_loops", "gravity_gradient_satellite"])
def test_consecutive_samples_of_a_picture_are_close(scene):
    coarse = symrot.propagate(scene).resample(40)
    motion = plot.dense(coarse)
    assert rotation_between_samples(motion) < 0.1
    assert motion.t[0] == coarse.t[0] and motion.t[-1] == coarse.t[-1]
    assert coarse.omega.max() <= motion.omega.max() * (1 + 1e-12)
    assert rotation_between_samples(coarse) > 0.1  # the samples of the trajectory are not


def test_samples_of_a_motion_with_too_many_rotations_meet_all_phases(monkeypatch):
    """The quaternion of the Earth returns every two days; 611 even samples of 610 days would see few of its phases."""
    monkeypatch.setattr(plot, "FEWEST", 611)
    monkeypatch.setattr(plot, "MOST", 611)
    motion = plot.dense(symrot.propagate("earth_wobble"))
    assert len(motion) == 611 and (np.diff(motion.t) > 0).all()
    phases = np.sort(np.arctan2(motion.quaternion[:, 3], motion.quaternion[:, 0]))
    assert np.diff(phases).max() < 0.2


def test_a_panel_draws_the_extremes_between_the_samples():
    coarse = symrot.propagate("t_handle").resample(7)
    axes = coarse.plot(Figure().add_subplot())
    drawn = np.concatenate([line.get_ydata() for line in axes.lines])
    exact = symrot.propagate("t_handle").resample(20_000).omega
    assert np.nanmax(drawn) == pytest.approx(exact.max(), rel=1e-4)
    assert coarse.omega.max() < 0.999 * exact.max() or coarse.omega[:, :2].max() < 0.9 * exact[:, :2].max()


def test_the_local_vertical_is_the_one_of_the_proven_jacobi_integral():
    """T + 3/2 n^2 r.I r - n L_z is the invariant of the kernel only if r is the radius that the torque has."""
    motion = symrot.propagate("gravity_gradient_satellite").resample(200)
    rate = float(motion.scene.torques[0].number("mean_motion"))
    inertia = np.array(motion.scene.body.inertia, dtype=float)
    jacobi = next(item.values for item in motion.invariants if item.name == "Jacobi integral")
    momentum_z = motion.dcm[:, 2] * motion.angular_momentum_body

    def integral(radius_s):
        radius_b = np.einsum("nij,ni->nj", motion.dcm, radius_s)
        tide = 1.5 * rate**2 * np.einsum("ni,ij,nj->n", radius_b, inertia, radius_b)
        return motion.kinetic_energy + tide - rate * momentum_z.sum(axis=1)

    size = np.abs(jacobi).max()
    assert np.abs(integral(local_vertical(motion.t, rate)) - jacobi).max() < 1e-11 * size
    assert np.abs(integral(local_vertical(motion.t, 1.01 * rate)) - jacobi).max() > 1e-3 * size  # a wrong radius


def test_the_angles_of_a_satellite_to_the_vertical_agree_with_each_other():
    motion = symrot.propagate("gravity_gradient_satellite").resample(300)
    in_plane, out_of_plane, whole = vertical_angles(motion).columns.T
    assert np.allclose(np.cos(whole), np.cos(in_plane) * np.cos(out_of_plane), atol=1e-14)
    assert np.degrees(in_plane[0]) == pytest.approx(20) and np.degrees(out_of_plane[0]) == pytest.approx(-5)
    assert np.degrees(whole.max()) < 25  # it librates


def test_the_angle_of_a_top_gives_its_potential_energy():
    motion = symrot.propagate("heavy_top_loops").resample(200)
    gravity = motion.scene.torques[0]
    moment = float(gravity.number("weight")) * np.linalg.norm([float(x) for x in gravity.vector("center_of_mass")])
    energy = next(item.values for item in motion.invariants if item.name == "energy")
    (angle,) = vertical_angles(motion).columns.T
    assert np.allclose(motion.kinetic_energy + moment * np.cos(angle), energy, rtol=1e-14)


@pytest.mark.parametrize(("scene", "expected"), [
    ("gravity_gradient_satellite", True), ("precessing_wheel", True), ("t_handle", False), ("spin_up", False),
])  # fmt: skip
def test_only_scenes_with_a_vertical_have_its_panel(scene, expected):
    motion = symrot.propagate(scene)
    assert has_vertical(motion.scene) is expected
    titles = [axes.get_title() for axes in plot.figure(motion.resample(50)).axes]
    assert any("vertical" in title for title in titles) is expected


@pytest.mark.parametrize(("sequence", "expected"), [
    ("ZXZ", ["phi about Z", "theta about X", "psi about Z"]), ("xyz", ["phi about x", "theta about y", "psi about z"]),
])  # fmt: skip
def test_angles_are_named_by_their_letters(sequence, expected):
    scene = symrot.load_scene("heavy_top_loops").with_({"output.sequence": sequence})
    axes = symrot.propagate(scene).plot(Figure().add_subplot(), "attitude")
    names = [name.replace("$", "").replace("\\", "") for name in axes.get_legend_handles_labels()[1]]
    assert names == expected


def path_points(axes):
    """Return the drawn points of a path, shape (n, 2)."""
    lines = [item for item in axes.collections if isinstance(item, LineCollection)]
    return np.concatenate([segment for line in lines for segment in line.get_segments()])


def ring(colatitude, points=2000):
    turn = np.linspace(0, 2 * np.pi, points)
    return np.stack([
        np.sin(colatitude) * np.cos(turn), np.sin(colatitude) * np.sin(turn), np.full(points, np.cos(colatitude))
    ], axis=1)  # fmt: skip


@pytest.mark.parametrize("degrees", [0.001, 3.0, 12.0, 20.0, 37.0, 48.0])
def test_a_small_path_is_enlarged_until_it_fills_its_panel(degrees):
    axes = Figure().add_subplot()
    sphere.draw_directions(axes, ring(np.radians(degrees)), ("x", "y", "z"))
    points = path_points(axes)
    low, high = np.array([axes.get_xlim(), axes.get_ylim()]).T
    assert (points > low).all() and (points < high).all()
    assert (np.ptp(points, axis=0) > 0.75 * (high - low)).all()


@pytest.mark.parametrize("degrees", [50.0, 90.0, 130.0])
def test_a_wide_path_is_drawn_on_the_whole_sphere(degrees):
    axes = Figure().add_subplot()
    sphere.draw_directions(axes, ring(np.radians(degrees)), ("x", "y", "z"))
    assert axes.get_xlim() == (-sphere.ROOM, sphere.ROOM) and not axes.child_axes


def test_an_enlarged_path_is_seen_without_distortion():
    """Seen from above its middle, a circle about the vertical is a circle of radius sin(angle)."""
    axes = Figure().add_subplot()
    sphere.draw_directions(axes, ring(np.radians(30)), ("x", "y", "z"))
    assert np.allclose(np.linalg.norm(path_points(axes), axis=1), 0.5, atol=1e-3)
    assert len(axes.child_axes) == 1  # the whole sphere


def test_directions_that_jump_are_not_joined():
    half = ring(np.radians(60))[:400]
    axes = Figure().add_subplot()
    sphere.draw_directions(axes, np.concatenate([half, -half]), ("x", "y", "z"))
    lines = [item for item in axes.collections if isinstance(item, LineCollection)]
    steps = [np.linalg.norm(np.diff(segment, axis=0), axis=1) for line in lines for segment in line.get_segments()]
    assert max(step.max(initial=0) for step in steps) < 0.1
    axes = Figure().add_subplot()
    sphere.draw_directions(axes, np.random.default_rng(2).normal(size=(500, 3)), ("x", "y", "z"))
    assert len(axes.collections) == 1 and not isinstance(axes.collections[0], LineCollection)


def test_drift_never_falls_and_names_what_does_not_change():
    axes = symrot.propagate("heavy_top_loops").plot(Figure().add_subplot(), "drift")
    names = axes.get_legend_handles_labels()[1]
    assert {name.partition(" (")[0] for name in names} == {
        item.name.replace("omega_3", r"$\omega_3$") for item in symrot.propagate("heavy_top_loops").invariants
    }
    for line in axes.lines:
        values = np.asarray(line.get_ydata(), dtype=float)
        assert (np.diff(values[np.isfinite(values)]) >= 0).all()


@pytest.mark.parametrize(("width", "place"), [(5.0, "left"), (5.0, "center"), (9.0, "left"), (9.0, "center")])
@pytest.mark.parametrize("panel", ["attitude", "rates", "vertical"])
def test_a_legend_never_covers_the_title(width, place, panel):
    with rc_context({"axes.titlelocation": place}):
        page = Figure(figsize=(width, 4.0))
        axes = symrot.propagate("gravity_gradient_satellite").plot(page.add_subplot(), panel)
        page.draw_without_rendering()
        title = next(text for text in (axes.title, axes._left_title) if text.get_text())
        assert not axes.get_legend().get_window_extent().overlaps(title.get_window_extent())


@pytest.mark.thinned(3)
@pytest.mark.parametrize("scene", ["earth_wobble", "gravity_gradient_satellite", "heavy_top_loops"])
def test_no_legend_of_a_page_covers_a_title(scene):
    with rc_context(STYLE):
        page = plot.figure(plot.dense(symrot.propagate(scene)))
        page.draw_without_rendering()
        legends = [axes.get_legend().get_window_extent() for axes in page.axes if axes.get_legend()]
        titles = [axes._left_title.get_window_extent() for axes in page.axes]
        assert len(legends) >= 3 and not any(legend.overlaps(title) for legend in legends for title in titles)


def test_a_motion_without_a_dense_solution_is_drawn_from_its_samples(tmp_path):
    """Motions of ensembles and of files have samples alone; an ensemble as a whole is refused in a sentence."""
    ensemble = symrot.propagate_ensemble("t_handle", omega=np.array([[0.01, 0, 12], [0.02, 0, 12]]))
    motion = symrot.propagate("t_handle")
    motion.save(tmp_path / "motion.npz")
    for drawn in (ensemble[1], symrot.load(tmp_path / "motion.npz")):
        axes = symrot.plot(drawn, Figure().add_subplot())
        assert {len(line.get_xdata()) for line in axes.lines if len(line.get_xdata())} == {len(drawn.t)}
        with pytest.raises(symrot.InputError, match="panel: expected"):
            symrot.plot(drawn, Figure().add_subplot(), "drift")
    with pytest.raises(symrot.InputError, match="panel: expected 'rates' for a motion from a file"):
        symrot.plot(drawn, Figure().add_subplot(), "body")
    with pytest.raises(symrot.InputError, match="plot: expected one motion, got an ensemble"):
        symrot.plot(ensemble, Figure().add_subplot())
    with pytest.raises(symrot.InputError, match=r"plot: expected a trajectory, .* got 't_handle'"):
        symrot.plot("t_handle")
