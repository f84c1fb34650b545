"""The catalogue: every derivation derives, none is vacuous, and the printed pages are current."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from sympy import Matrix, MatrixBase, Rational, Symbol

from symrot import catalogue
from symrot.conventions import SEQUENCES
from symrot.errors import InputError
from symrot.exact import is_zero

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def derived():
    return {name: catalogue.derivation(name) for name in catalogue.names()}


@pytest.fixture(scope="module")
def printed():
    return catalogue.pages()


def test_the_reading_order_names_every_file_once():
    files = {path.stem for path in (ROOT / "symrot" / "catalogue").glob("*.py") if not path.stem.startswith("_")}
    assert len(catalogue.names()) == len(set(catalogue.names()))
    assert set(catalogue.names()) == files


def test_an_unknown_derivation_is_refused():
    with pytest.raises(InputError, match=r"'no_such'.*euler_equations"):
        catalogue.derivation("no_such")


@pytest.mark.parametrize("name", catalogue.names())
def test_no_step_would_hold_with_an_error(derived, name):
    """With a small amount added to one side, every equation fails under the same hypotheses: none is vacuous."""
    steps = [step for step in derived[name].steps if step.relation == "="]
    assert steps
    error = Rational(1, 10**9) * Symbol("error", positive=True)
    for step in steps[:12]:
        left, right = step.left, step.right
        if isinstance(left, MatrixBase):
            difference = Matrix(left) - Matrix(right)
            difference[len(difference) - 1] += error
        else:
            difference = left - right + error
        assert not is_zero(difference, step.hypotheses), step.claim


@pytest.mark.parametrize("name", catalogue.names())
def test_a_page_is_a_page(derived, name):
    found = derived[name]
    assert found.name == name and found.title and found.source and found.about
    for step in found.steps:
        assert step.claim[0].isupper() and step.claim[-1] in ".:,", step.claim
        assert step.reason and not step.reason.endswith("."), step.reason


def test_every_sequence_has_its_rates(derived):
    titles = [item.title for item in derived["euler_body_rates"].items if hasattr(item, "title")]
    assert [title.split(",")[0] for title in titles] == list(SEQUENCES)


def test_what_the_planner_and_the_docstrings_cite_exists():
    cited = set()
    for path in (ROOT / "symrot").rglob("*.py"):
        for word in path.read_text().split():
            if word.strip("`.,;").startswith("derivations/") and word.strip("`.,;").endswith(".md"):
                cited.add(word.strip("`.,;").removeprefix("derivations/").removesuffix(".md"))
    assert cited - {"", "*"} <= set(catalogue.names())


def test_the_committed_pages_are_current(printed):
    """Run `symrot derive --all` when this fails."""
    directory = ROOT / "derivations"
    assert {path.name for path in directory.glob("*.md")} == set(printed)
    for name, text in printed.items():
        assert (directory / name).read_bytes() == text.encode(), name


def test_check_finds_what_is_stale_missing_and_left_over(tmp_path, printed, monkeypatch):
    monkeypatch.setattr(catalogue, "pages", lambda: printed)
    assert len(catalogue.derive_all(tmp_path)) == len(printed)
    assert catalogue.check(tmp_path) == [] and catalogue.derive_all(tmp_path) == []
    (tmp_path / "spherical_body.md").write_text(printed["spherical_body.md"].replace("**1.** The", "**1.** No"))
    (tmp_path / "planar_motion.md").unlink()
    (tmp_path / "old.md").write_text("Derived long ago, printed by `symrot derive old`; do not edit.\n")
    (tmp_path / "mine.md").write_text("My own notes.\n")
    stale = dict(catalogue.check(tmp_path))
    assert {path.name for path in stale} == {"spherical_body.md", "planar_motion.md", "old.md"}
    assert "\n-**1.** No tensor" in stale[tmp_path / "spherical_body.md"]
    assert "\n+**1.** The tensor" in stale[tmp_path / "spherical_body.md"]
    assert {path.name for path in catalogue.derive_all(tmp_path)} == {path.name for path in stale}
    assert catalogue.check(tmp_path) == [] and (tmp_path / "mine.md").exists() and not (tmp_path / "old.md").exists()


def test_a_page_does_not_depend_on_hashing(printed):
    program = (
        "from symrot.catalogue import derivation; import sys;"
        "sys.stdout.write(''.join(derivation(n).markdown() for n in ('symmetric_top', 'quaternion_rates',"
        "'gravity_gradient')))"
    )
    pages = {
        subprocess.run(
            [sys.executable, "-c", program],
            env=os.environ | {"PYTHONHASHSEED": seed},
            capture_output=True,
            check=True,
        ).stdout.decode()
        for seed in ("1", "20")
    }
    assert pages == {
        "".join(printed[f"{name}.md"] for name in ("symmetric_top", "quaternion_rates", "gravity_gradient"))
    }


def test_the_catalogue_is_named_without_sympy():
    program = "import sys, symrot.catalogue as c; c.names(); sys.exit('sympy' in sys.modules)"
    subprocess.run([sys.executable, "-c", program], check=True)
