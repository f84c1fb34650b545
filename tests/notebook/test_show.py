"""What a notebook shows: every class has a short text and a rich one, and text of users cannot become markup."""

import re
from dataclasses import replace

import pytest

import symrot
from symrot.notebook.fragments import Markup, table
from symrot.notebook.show import RENDERERS

pytestmark = pytest.mark.usefixtures("quick_compiler")

VALUES = {
    "Trajectory": lambda: symrot.propagate("t_handle", t=[0.0, 1.0]),
    "Scene": lambda: symrot.load_scene("heavy_top_loops"),
    "Plan": lambda: symrot.plan("tumbling_prism"),
    "Propagator": lambda: symrot.propagator("tumbling_prism"),
    "Ensemble": lambda: symrot.propagate_ensemble("tumbling_prism", omega=[[0, 1, 0.1]] * 2, t=[0.0, 1.0]),
    "Verdict": lambda: symrot.check("sin(2*x) == sin(x)*cos(x)"),
    "Identification": lambda: symrot.identify("m*R**2/2")[0],
    "Page": lambda: symrot.derivation("intermediate_axis"),
    "Step": lambda: symrot.derivation("intermediate_axis").steps[0],
    "Solid": lambda: symrot.solid("cone"),
    "SingularityDossier": lambda: symrot.singularity_dossier("ZXZ"),
    "Emitted": lambda: symrot.emit("euler_zxz_body_rates"),
}
CONTENT = {
    "Trajectory": "<iframe", "Scene": "heavy_top_loops", "Plan": "operations instead of", "Propagator": "free body", "Ensemble": "omega_3",
    "Verdict": "<mark>2*</mark>", "Identification": "cylinder", "Page": "$$", "Step": "*Why:*", "Solid": r"\frac{3 R^{2} m}{10}",
    "SingularityDossier": r"\det B = - \sin \theta", "Emitted": "```c",
}  # fmt: skip


def test_every_class_that_a_notebook_shows_is_tried():
    assert set(VALUES) == set(CONTENT) == set(RENDERERS)


@pytest.mark.parametrize("name", VALUES)
def test_a_value_has_a_short_text_and_a_rich_one(name):
    value = VALUES[name]()
    assert len(repr(value)) < 200 and "\n" not in repr(value)
    hook = getattr(value, "_repr_html_", None) or value._repr_markdown_
    assert CONTENT[name] in hook()
    assert hook() == symrot.in_notebook(value)


def test_a_motion_at_a_single_time_is_shown_as_text():
    motion = VALUES["Trajectory"]().at(0.5)
    assert motion._repr_html_() is None
    with pytest.raises(symrot.InputError, match="over a span of time"):
        symrot.in_notebook(motion)


def test_part_of_a_derivation_is_shown_without_figures():
    text = symrot.in_notebook(symrot.derivation("poinsot").part(1))
    assert "data:image" not in text and "$$" in text


def test_a_derivation_is_shown_with_its_figures_and_plain_dollars():
    text = symrot.in_notebook(symrot.derivation("poinsot"))
    assert text.count("data:image/svg+xml;base64,") >= 1
    assert "$`" not in text and "](poinsot" not in text


def test_text_of_users_is_escaped():
    title = "<script>alert(1)</script>"
    scene = replace(symrot.load_scene("t_handle"), title=title, name=title)
    assert "<script>" not in symrot.in_notebook(scene)
    verdict = replace(symrot.check("sin(x) == 1"), text="<b>", notes=("<b>",), reading="<b>")
    assert "<b>" not in symrot.in_notebook(verdict)
    assert table([("<b>", Markup("<i>"))]).count("<b>") == 0


def test_an_ensemble_of_motions_that_stopped_shows_how_many():
    ensemble = symrot.propagate_ensemble("tumbling_prism", omega=[[0, 1, 0.1]], t=[0.0, 1.0])
    ensemble._omega = ensemble._omega * float("nan")
    assert re.search("stopped early</td><td[^>]*>1<", symrot.in_notebook(ensemble))


@pytest.mark.parametrize("value", [3, "t_handle", None])
def test_other_values_are_refused(value):
    with pytest.raises(symrot.InputError, match="an object of one of the types Trajectory"):
        symrot.in_notebook(value)


def test_axes_in_space_are_refused():
    figure = pytest.importorskip("matplotlib.figure")
    with pytest.raises(symrot.InputError, match="axes in the plane"):
        symrot.propagate("t_handle").plot(figure.Figure().add_subplot(projection="3d"), "body")
