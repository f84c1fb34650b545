"""The list of stress tests is complete, the quick ones meet their bars, and wrong figures are noticed. All: ``python -m
tests.reference.stress``.
"""

import json
import math

import pytest

from tests.reference import stress
from tests.reference.figures import Figure

pytestmark = pytest.mark.usefixtures("quick_compiler")
FLAGS_THAT_SHIP = ("S23", "S28")  # their bars are those of fused operations
SUITE = ("S17", "S22", "S23", "S24", "S26", "S28", "S30", "S31", "S32", "S34", "S38", "S39", "S42",
         "F1", "F2", "F3", "F4", "F8")  # fmt: skip
# S1 to S16 and S18 to S21 are tests of their own (test_closed_form_*), as are S35 to S37 (test_conversions)


def test_the_list_is_complete():
    assert [each.id for each in stress.STRESSES] == [f"S{k}" for k in range(1, 43)]


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.shipped_flags] * (name in FLAGS_THAT_SHIP)) for name in SUITE]
)
def test_quick_ones_meet_their_bars(name):
    (found,) = (each for each in stress.STRESSES + stress.FOUND if each.id == name)
    for figure in found.run(False):
        assert figure.good or not figure.judged, figure


@pytest.mark.campaign
@pytest.mark.shipped_flags
@pytest.mark.parametrize("name", [each.id for each in stress.STRESSES + stress.FOUND if each.id != "S40"])
def test_all_meet_their_bars_at_full_length(name):
    (found,) = (each for each in stress.STRESSES + stress.FOUND if each.id == name)
    for figure in found.run(True):
        assert figure.good or not figure.judged, figure


def test_what_misses_its_bar_is_seen(monkeypatch, capsys):
    assert not Figure("m", "w", 1e-15, 2e-15).good and not Figure("m", "w", 2, 1.9, at_least=True).good
    assert not Figure("m", "w", 1, math.nan).good and not Figure("m", "w", 1, math.nan, at_least=True).good
    bad = stress.STRESSES[0]._replace(run=lambda long: [Figure("m", "w", 1e-15, 2e-15), Figure("m", "v", 1, 0)])
    monkeypatch.setattr(stress, "FOUND", ())
    monkeypatch.setattr(stress, "STRESSES", (bad,))
    assert stress.main([]) == 1
    assert "NOT MET" in capsys.readouterr().out
    assert stress.main(["--json", "--quick"]) == 1
    assert [row["verdict"] for row in json.loads(capsys.readouterr().out)] == ["NOT MET", "met"]
    monkeypatch.setattr(stress, "STRESSES", (bad._replace(run=lambda long: [Figure("m", "v", 1, 0)]),))
    assert stress.main([]) == 0
    with pytest.raises(SystemExit):
        stress.main(["S99"])
