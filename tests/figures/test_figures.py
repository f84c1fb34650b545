"""Figures: well-formed, described for readers of screens, the same bytes everywhere; and drawn where they must be."""

import re
from itertools import combinations
from xml.etree import ElementTree

import numpy as np
import pytest

from symrot.catalogue import names
from symrot.errors import InputError
from symrot.figures import attitude, free_bodies, mechanics, solids, tops
from symrot.figures.curves import clear_of, cone, outline, rotation
from symrot.figures.picture import Picture
from symrot.figures.table import FIGURES
from symrot.figures.view import Plane, View
from symrot.proof.page import Figure, Page
from symrot.workshop import derivation_pages

pytestmark = pytest.mark.first  # in the process that draws the figures for the pages of the catalogue

SVG = "{http://www.w3.org/2000/svg}"
ALL = [figure for figures in FIGURES.values() for figure in figures]


@pytest.fixture(scope="module")
def texts():
    return {figure.name: figure.svg() for figure in ALL}


@pytest.fixture(scope="module")
def trees(texts):
    return {name: ElementTree.fromstring(text) for name, text in texts.items()}


def test_at_least_25_pages_have_figures_and_each_figure_has_its_own_file():
    assert set(FIGURES) <= set(names()) and sum(map(bool, FIGURES.values())) >= 25
    assert len({figure.name for figure in ALL}) == len(ALL)


def test_letters_of_wide_figures_are_enlarged_on_a_phone(texts):
    """At the width of a phone no letter is smaller than 12 pixels; the rule names its figure, other figures keep theirs."""
    for text in texts.values():
        width = float(re.search(r' width="([\d.]+)"', text)[1])
        enlarged = re.search(
            r"@media \(max-width:([\d.]+)px\)\{\.sf\.sf\d+ text\{.*? text\.word\{font-size:([\d.]+)px", text
        )
        size = float(enlarged[2]) if enlarged else 13
        assert size * min(1, 358 / width) > 11.3
        assert (not enlarged) or (390 < float(enlarged[1]) < width and 'class="sf sf' in text)


def test_a_figure_is_a_document_that_stands_alone(texts, trees):
    for figure in ALL:
        tree, text = trees[figure.name], texts[figure.name].replace('xmlns="http://www.w3.org/2000/svg"', "")
        assert tree.tag == f"{SVG}svg" and tree.get("role") == "img", figure.name
        title, description = tree.findtext(f"{SVG}title"), tree.findtext(f"{SVG}desc")
        assert title == figure.title and len(description) > 30, figure.name
        assert not set("$\\{}`") & set(description), figure.name
        assert not re.search(r"http|href|url\(|@import|\bid=", text), figure.name
        assert "prefers-color-scheme:dark" in text and "nan" not in text, figure.name
        assert figure.caption.endswith(".") and figure.caption.count("$") % 2 == 0, figure.name


def test_nothing_is_drawn_outside_the_picture(trees):
    for name, tree in trees.items():
        x, y, width, height = map(float, tree.get("viewBox").split())
        for path in tree.iter(f"{SVG}path"):
            points = np.array(re.findall(r"-?[\d.]+", path.get("d")), dtype=float).reshape(-1, 2)
            assert np.all((points >= (x, y)) & (points <= (x + width, y + height))), name
        for text in tree.iter(f"{SVG}text"):
            assert x < float(text.get("x")) < x + width and y < float(text.get("y")) < y + height, name


def test_labels_do_not_overlap(trees):
    """Two labels are a line apart, or half their width."""
    for name, tree in trees.items():
        labels = [(float(t.get("x")), float(t.get("y")), "".join(t.itertext())) for t in tree.iter(f"{SVG}text")]
        for (x, y, text), (other_x, other_y, other) in combinations(labels, 2):
            apart = 3.0 * (len(text) + len(other))
            assert abs(y - other_y) > 8 or abs(x - other_x) > apart, (name, text, other)


def test_a_figure_for_a_section_that_a_page_lacks_is_refused(monkeypatch):
    figure = Figure("none", "None", "None.", Picture, "No such section")
    monkeypatch.setattr(derivation_pages, "figures_of", lambda name: (figure,))
    with pytest.raises(InputError, match="No such section"):
        derivation_pages.illustrated(Page("poinsot", "Poinsot"))


@pytest.mark.parametrize("azimuth, elevation", [(0, 0), (30, 20), (-75, 60), (200, -35), (10, 90)])
def test_projected_ends_of_an_arrow_are_the_projected_vectors(azimuth, elevation):
    """The axes of a view are orthonormal, so that lengths across the view are to scale; the eye is where it was put."""
    view = View(azimuth, elevation, 50.0, (7.0, -3.0))
    assert np.allclose(view.axes @ view.axes.T, np.eye(3)) and np.linalg.det(view.axes) == pytest.approx(1)
    assert np.allclose(view.project(view.toward), [(7.0, -3.0)])
    vector = np.array([0.3, -1.2, 0.8])
    (tip,) = view.project(vector)
    assert np.allclose(tip, (7 + 50 * view.axes[0] @ vector, -3 - 50 * view.axes[1] @ vector))
    picture = Picture()
    picture.arrow(view, (0, 0, 0), vector, "v", "red")
    paths = [p.get("d") for p in ElementTree.fromstring(picture.svg("a", "b")).iter(f"{SVG}path")]
    start, head = ([float(x) for x in re.findall(r"-?[\d.]+", path)[:2]] for path in paths)
    assert np.allclose(start, (7, -3), atol=0.01) and np.allclose(head, tip, atol=0.01)


def test_up_is_up():
    (low,), (high,) = View().project((0, 0, 0)), View().project((0, 0, 1))
    assert high[1] < low[1] and Plane().project((0, 1))[0, 1] < 0


def test_the_same_figure_has_the_same_bytes(texts):
    assert all(figure.svg() == texts[figure.name] for figure in ALL[::7])


def test_numbers_do_not_flicker_at_the_border_of_two_roundings():
    for value in (0.125, 33.335, -2.005):
        lines = []
        for error in (-1e-13, 0.0, 1e-13):
            picture = Picture()
            picture.curve(Plane(1.0), [(0, 0), (value + error, 1)])
            lines.append(picture.svg("a", "b"))
        assert len(set(lines)) == 1


# --- what is drawn is what it is said to be ---------------------------------------------------------------------------


def test_polhode_is_on_the_ellipsoid_and_herpolhode_on_the_plane():
    moments, motion = free_bodies.rolling_ellipsoid()
    height = motion.omega_space[:, 2]
    assert np.allclose(height, height[0], atol=1e-12)
    for place in (0, 40, 200):
        shape = free_bodies.contact_ellipsoid(moments, motion, place)
        polhode = motion.omega @ motion.dcm[place].T
        assert np.allclose(np.einsum("ni,ij,nj->n", polhode, shape, polhode), 1.0, atol=1e-12)
        normal = shape @ motion.omega_space[place]  # the plane touches the ellipsoid at the end of omega
        assert np.allclose(normal / np.linalg.norm(normal), (0, 0, -1), atol=1e-12)


def test_polhodes_are_closed_and_the_separatrix_has_the_momentum_of_the_intermediate_axis():
    loops, planes = free_bodies.polhode_curves()
    intermediate = free_bodies.MOMENTS[1]
    for curve in [*loops, *planes]:
        assert np.allclose(curve**2 @ free_bodies.MOMENTS, 1.0, atol=1e-9)
        assert np.allclose(curve[0], curve[-1], atol=2e-3)
    for plane in planes:
        assert np.allclose(plane**2 @ free_bodies.MOMENTS**2, intermediate, atol=1e-9)


def test_body_cone_and_space_cone_touch_along_omega():
    for moments, nutation, sign in (((3.0, 1.0), 50, 1), ((1.0, 1.7), 26, -1)):
        momentum, omega, axis = free_bodies.cone_vectors(moments, np.radians(nutation))
        assert abs(np.linalg.det([momentum, omega, axis])) < 1e-12  # all in one plane
        body, space = np.arccos(axis @ omega), np.arccos(momentum @ omega)
        assert np.arccos(axis @ momentum) == pytest.approx(body + sign * space)  # outside, or inside


def test_outlines_are_where_the_normal_is_across_the_view():
    view = View(33, 21)
    matrix = rotation((1, 2, 3), 40.0)
    shape = matrix @ np.diag([1.0, 2.5, 6.0]) @ matrix.T
    points = outline(shape, view)
    assert np.allclose(np.einsum("ni,ij,nj->n", points, shape, points), 1.0)
    assert np.allclose(points @ shape @ view.toward, 0.0, atol=1e-12)
    axis, half = np.array([0.3, -0.4, 0.5]) / np.sqrt(0.5), 0.4
    _, sides = cone(axis, half, 1.0, view)
    assert len(sides) == 2
    for _, end in sides:
        normal = end / np.cos(half) - axis * (end @ end) / (end @ axis) / np.cos(half)
        assert end @ axis == pytest.approx(np.cos(half)) and normal @ view.toward == pytest.approx(0, abs=1e-9)


def test_an_ellipsoid_hides_what_is_behind_it_alone():
    view = View(0, 0)  # the eye is on axis 1
    points = np.array([[2.0, 0, 0], [-2.0, 0, 0], [-2.0, 1.5, 0], [0, 0, 1.2]])
    assert clear_of(np.eye(3), points, view).tolist() == [True, False, True, True]


def test_a_solid_hides_its_back_edges():
    """Of the twelve edges of a box three are hidden, and the lines of the figure are on the box."""
    surface = solids.surface_of(solids.sized("box"))
    edges = {tuple(map(tuple, np.round(edge[[0, -1]], 9).tolist())): edge for edge in surface.edges}
    middles = np.array([(np.array(a) + np.array(b)) / 2 for a, b in edges])
    assert len(middles) == 12 and surface.hides(middles, solids.VIEW).sum() == 3
    half = np.array([1.5, 1.1, 0.7]) / 2
    assert np.allclose(np.max(np.abs(np.concatenate(surface.edges)) / half, axis=1), 1.0)


@pytest.mark.parametrize("name, inside", [("sphere", 0.8), ("cylinder", 0.8), ("torus", 1.05)])
def test_the_outline_of_a_solid_is_that_of_its_points(name, inside):
    body = solids.sized(name)
    corners = solids.hull(solids.surface_of(body).triangles.reshape(-1, 3) @ solids.VIEW.axes[:2].T)
    turned = np.roll(corners, -1, axis=0) - corners
    after = np.roll(turned, -1, axis=0)
    assert np.all(turned[:, 0] * after[:, 1] - turned[:, 1] * after[:, 0] > 0)
    assert np.max(np.abs(corners[:, 0])) == pytest.approx(inside, rel=2e-3)


def test_turning_points_are_where_the_potential_is_the_energy():
    motion = tops.top_motion((0.0, 0.0, tops.SPIN), tops.START, np.linspace(0, 10, 2001))
    nutation = np.arccos(motion.dcm[:, 2, 2])
    p_phi, p_psi = motion.angular_momentum_space[0, 2], motion.angular_momentum_body[0, 2]
    at = tops.effective_potential()
    energy = motion.energy[0]
    assert at(nutation.min(), p_phi, p_psi, tops.A, tops.C) == pytest.approx(energy, abs=1e-6)
    assert at(nutation.max(), p_phi, p_psi, tops.A, tops.C) == pytest.approx(energy, abs=1e-6)
    assert at(nutation.mean(), p_phi, p_psi, tops.A, tops.C) < energy - 1e-3


@pytest.mark.parametrize("speed, reverses", [(1.4, True), (2.5, False)])
def test_phase_curves_of_the_pendulum_keep_its_energy(speed, reverses):
    theta, rate = tops.pendulum_angle(speed, np.linspace(0, 9, 181))
    assert np.allclose(rate**2 / 2 - np.cos(theta), speed**2 / 2 - 1, atol=1e-10)
    assert (rate.min() < 0) == reverses


def test_the_tidal_force_stretches_along_the_radius_and_squeezes_across_it():
    radius, offset = np.array([0.0, 1.0]), np.array([0.3, 0.4])
    assert np.allclose(tops.tidal_force(offset, radius), 3 * (radius @ offset) * radius - offset, atol=1e-9)


def test_locked_gimbals_have_two_axes_in_one_line():
    outer, middle, inner = attitude.gimbals("ZYX", (25.0, 90.0, 20.0))
    assert np.allclose(outer, -inner) and abs(outer @ middle) < 1e-12
    outer, _, inner = attitude.gimbals("ZYX", (25.0, 35.0, 20.0))
    assert np.linalg.norm(np.cross(outer, inner)) > 0.5


def test_bars_keep_their_lengths_and_gears_roll():
    phi = np.linspace(0, 2 * np.pi, 37)
    first, second = mechanics.four_bar_positions(phi)
    ground = np.array([mechanics.BARS["ground"], 0.0])
    for points, length in ((first, "a"), (second - first, "b"), (second - ground, "c")):
        assert np.allclose(np.linalg.norm(points, axis=1), mechanics.BARS[length])
    rest = -1.0 / (mechanics.struck_velocities(0.62, np.array([1.0]))[0] - 1.0)
    assert rest * 0.62 == pytest.approx(-1 / 3)  # d * distance of the centre of percussion = moment / mass
