"""The notebooks of the documentation run, and give the outputs that are stored in them."""

import json

import pytest

from tests.notebook import cells

pytestmark = pytest.mark.usefixtures("quick_compiler")

NAMES = [path.stem for path in cells.paths()]


def test_there_are_the_four_notebooks():
    assert NAMES == ["checking_a_paper", "free_bodies", "heavy_top", "textbook_to_kernel"]


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_gives_its_stored_outputs(name):
    pytest.importorskip("matplotlib")
    path = cells.NOTEBOOKS / f"{name}.ipynb"
    assert cells.comparable(cells.outputs_of(path)) == cells.comparable(cells.stored(path))


def test_another_output_is_noticed():
    path = cells.NOTEBOOKS / "checking_a_paper.ipynb"
    outputs = cells.stored(path)
    outputs[1][0]["data"]["text/plain"] = ["<Verdict false: 1 = 1>"]
    assert cells.comparable(outputs) != cells.comparable(cells.stored(path))


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_is_small_and_names_no_machine(name):
    path = cells.NOTEBOOKS / f"{name}.ipynb"
    text = path.read_text("utf-8")
    assert len(text) < 300_000
    assert "/home/" not in text and "/tmp" not in text and "site-packages" not in text
    content = json.loads(text)
    assert (content["nbformat"], content["nbformat_minor"]) == (4, 5)
    assert len({cell["id"] for cell in content["cells"]}) == len(content["cells"])
