"""The mark ``thinned``: which cases run by default, and that ``pytest -m campaign`` runs all of them."""

from pathlib import Path

pytest_plugins = ["pytester"]

CASES = """
import pytest

@pytest.mark.thinned(4)
@pytest.mark.parametrize("method", "abc")
@pytest.mark.parametrize("torque", "uvwxy")
def test_axes(method, torque):
    pass

@pytest.mark.thinned(3)
@pytest.mark.parametrize("name", range(7))
def test_names(name):
    pass

@pytest.mark.thinned(2)
@pytest.mark.parametrize("order", [1, pytest.param(2, marks=pytest.mark.campaign), 3])
def test_marked(order):
    pass

def test_plain():
    pass
"""


def collected(pytester, *options):
    result = pytester.runpytest_inprocess("--collect-only", "-q", "-p", "no:xdist", "-p", "no:cacheprovider", *options)
    return {line.partition("::")[2] for line in result.outlines if "::" in line}


def test_every_nth_case_and_every_value_of_an_axis_stay(pytester):
    hook = (Path(__file__).parent / "conftest.py").read_text(encoding="utf-8")
    pytester.makeconftest(hook)
    pytester.makeini("[pytest]\nmarkers = campaign\n    thinned")
    pytester.makepyfile(CASES)
    kept, left = collected(pytester, "-m", "not campaign"), collected(pytester, "-m", "campaign")
    assert {name for name in kept if "axes" not in name} == {
        "test_names[0]", "test_names[3]", "test_names[6]", "test_marked[1]", "test_plain",
    }  # fmt: skip
    axes = {name[len("test_axes[") : -1] for name in kept if "axes" in name}
    assert axes == {"u-a", "v-b", "w-c", "y-a", "x-a"}  # every fourth, and the first that has x
    assert not kept & left
    assert len(kept | left) == 3 * 5 + 7 + 3 + 1
