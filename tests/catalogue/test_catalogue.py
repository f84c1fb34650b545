"""Laws of the catalogue: every derivation can be derived, no step is vacuous, and the printed pages are up to date."""

import os
import re
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from xml.etree import ElementTree

import pytest
from sympy import MatrixBase, Poly, Rational, Symbol

from symrot import catalogue
from symrot.catalogue.angular_velocity import euler_body_rates
from symrot.catalogue.tools.power_series import coefficient, indexed
from symrot.cli.main import main
from symrot.conventions import SEQUENCES
from symrot.errors import InputError
from symrot.exact import is_zero
from symrot.lessons.other_names import OTHER_NAMES
from symrot.lessons.page import APPENDIX
from symrot.lessons.table import LESSONS
from symrot.proof.derivation import Derivation, ProofError
from symrot.proof.page import Page, Step, Table
from symrot.proof.pages import latex_book, latex_document
from symrot.proof.pages.book import search_script
from symrot.proof.pages.math_font import characters
from symrot.workshop import derivation_pages
from tests.proof.book_search import NODE, pages_of

pytestmark = pytest.mark.first  # all pages are derived once, for these tests and for those of lessons

ROOT = Path(__file__).parents[2]


SPREAD = ("heavy_top", "gear_trains", "gravity_gradient")
ASKED = {  # what a course asks for, and the derivation that has it
    "orthogonality": "rotation_matrices", "Rodrigues": "axis_and_angle", "order": "composition", "spin": "spin_tensor",
    "lock": "euler_singularities", "Euler parameters": "euler_parameters", "two points": "relative_motion",
    "particle sum": "angular_momentum", "energy": "kinetic_energy", "solids": "standard_solids", "Poinsot": "poinsot",
    "Lagrange": "lagrange_and_euler", "top": "heavy_top", "wheel": "gyroscopic_wheel", "Jacobi": "free_asymmetric_body",
    "power": "work_and_power", "blow": "impulse_and_momentum", "rolling": "rolling", "Willis": "gear_trains",
    "slider": "planar_linkages", "theta functions": "free_body_attitude", "pendulum": "pendulum",
    "nutation in time": "heavy_top_motion", "rotor": "symmetric_gyrostat", "motor and brake": "driven_rotation",
}  # fmt: skip


@pytest.fixture(scope="module")
def derived():
    return {name: catalogue.derivation(name) for name in catalogue.names()}


@pytest.fixture(scope="module")
def printed():
    return derivation_pages.pages()


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Return the folder with all pages in HTML."""
    directory = tmp_path_factory.mktemp("book") / "site"
    assert main(["derive", "--all", "--format", "html", "-o", str(directory)]) == 0
    return directory


def test_the_reading_order_names_every_file_once():
    files = [path.relative_to(ROOT).with_suffix("") for path in (ROOT / "symrot" / "catalogue").glob("*/*.py")]
    modules = {".".join(file.parts) for file in files if file.name != "__init__" and file.parent.name != "tools"}
    assert len(catalogue.names()) == len(set(catalogue.names()))
    assert set(map(catalogue.module_of, catalogue.names())) == modules


def test_an_unknown_derivation_is_refused():
    with pytest.raises(InputError, match=r"euler_equations.*'no_such'"):
        catalogue.derivation("no_such")


@pytest.mark.parametrize("name", catalogue.names())
def test_no_step_would_hold_with_an_error(derived, name):
    """With a small amount added to one side, every equation fails under the same hypotheses, so no step is vacuous.

    Only hypotheses could make a step vacuous; of the steps without hypotheses, the last one of a page is tried.
    """
    steps = [step for step in derived[name].steps if step.relation == "="]
    assert steps
    error = Rational(1, 10**9) * Symbol("error", positive=True)
    for step in [step for step in steps if step.hypotheses] or steps[-1:]:
        # of two matrices, the last entries
        left, right = ((side[-1] if isinstance(side, MatrixBase) else side) for side in (step.left, step.right))
        assert not is_zero(left - right + error, step.hypotheses), step.claim


def test_a_page_is_a_page(derived):
    for name, found in derived.items():
        assert found.name == name and found.title and found.source and found.about, name
        for step in found.steps:
            assert step.claim[0].isupper() and step.claim[-1] in ".:,", (name, step.claim)
            assert step.reason and not step.reason.endswith("."), (name, step.reason)


IN_WORDS = {  # right sides that are typed in words or names beside what was proven: fewer is better, more is a fault
    "euler_body_rates": 24, "euler_parameters": 13, "euler_singularities": 12, "rotation_matrices": 5,
    "angular_momentum": 4, "quaternion_rates": 3, "rotation_vector": 3, "rodrigues": 3, "symmetric_top": 3,
}  # fmt: skip


def test_what_is_shown_is_what_was_proven(derived):
    """Each side of an equation is printed from the proof, or its LaTeX is parsed and proven equal when the step is
    added.
    """
    for name, found in derived.items():
        words = [step.display for step in found.steps if not step.printed[1]]
        assert len(words) <= IN_WORDS.get(name, 2), (name, words)


def test_a_tampered_page_cannot_be_derived(monkeypatch):
    """The test changes one sign in a displayed formula, but nothing in the proven formulas."""
    add = Derivation.step

    def tampered(page, claim, left, right, *, display=None, **others):
        changed = display.replace("+", "-", 1) if isinstance(display, str) else display
        return add(page, claim, left, right, display=changed, **others)

    monkeypatch.setattr(Derivation, "step", tampered)
    for name in ("kinetic_energy", "relative_motion", "free_body_attitude", "rodrigues", "tensor_rotation"):
        with pytest.raises(ProofError, match="as displayed"):
            import_module(catalogue.module_of(name)).derive()


def test_every_sequence_has_its_rates():
    tables = [item for item in catalogue.derivation("euler_body_rates").items if isinstance(item, Table)]
    names = [cells[0] for table in tables for cells, steps in table.rows if len(steps) == 4]
    assert sorted([euler_body_rates.EXAMPLE, *names]) == sorted(SEQUENCES)


def test_a_table_numbers_the_steps_that_prove_its_rows():
    """Each number of a step stands once on the page, and one step of a row can be printed by its number."""
    page = catalogue.derivation("euler_singularities")
    numbers = [int(number) for number in re.findall(r"^\*\*(\d+)\.\*\*", page.markdown(), re.MULTILINE)]
    for first, last in re.findall(r"^\| (\d+)–(\d+) \|", page.markdown(), re.MULTILINE):
        numbers += range(int(first), int(last) + 1)
    assert numbers == list(range(1, len(page.steps) + 1))
    assert page.part(40).steps == (page.steps[39],)


def test_the_euler_pages_argue_once():
    pages = map(catalogue.derivation, ("euler_body_rates", "euler_singularities"))
    assert sum(page.markdown().count("\n") for page in pages) < 400


def test_the_coefficient_of_a_power_is_that_of_the_product():
    """The reference is a product of polynomials, expanded and differentiated by SymPy."""
    x, k = Symbol("x"), Symbol("k")
    series = {"a": [2, -3, 5, 7, 0, 1], "b": [1, 4, -2, 0, 3, 9]}
    factors = {"a": {0: x**2 - 3, 1: 2 * x, 2: x**3 + 1}, "b": {0: 4 * x, 1: 1 - x**2}}
    sums = {name: sum(value * x**n for n, value in enumerate(values)) for name, values in series.items()}
    whole = sum(factor * sums[name].diff(x, order) for name, own in factors.items() for order, factor in own.items())
    one = coefficient(factors, x, k)
    values = {indexed(name, k, shift): (name, shift) for name in series for shift in range(-3, 4)}
    for n in range(12):
        numbers = {
            symbol: series[name][n + shift] if 0 <= n + shift < 6 else 0 for symbol, (name, shift) in values.items()
        }
        assert one.subs(numbers).subs(k, n) == Poly(whole, x).coeff_monomial(x**n)


def test_what_the_planner_and_the_docstrings_cite_exists():
    cited = {
        name
        for path in (ROOT / "symrot").rglob("*.py")
        for name in re.findall(r"derivations/(\w+)\.md", path.read_text())
    }
    assert cited <= set(catalogue.names())


def test_the_committed_pages_are_current(printed):
    """If this test fails, run `symrot derive --all`."""
    directory = ROOT / "derivations"
    files = [*directory.glob("*.md"), *directory.glob("figures/*")]
    assert {path.relative_to(directory).as_posix() for path in files} == set(printed)
    for name, text in printed.items():
        assert (directory / name).read_bytes() == text.encode(), name


def test_check_finds_what_is_stale_missing_and_left_over(tmp_path, printed, monkeypatch):
    monkeypatch.setattr(derivation_pages, "pages", lambda say: printed)
    assert len(derivation_pages.derive_all(tmp_path)) == len(printed)
    assert derivation_pages.check(tmp_path) == [] and derivation_pages.derive_all(tmp_path) == []
    (tmp_path / "spherical_body.md").write_text(printed["spherical_body.md"].replace("**1.** The", "**1.** No"))
    (tmp_path / "planar_motion.md").unlink()
    (tmp_path / "old.md").write_text("Derived long ago, printed by `symrot derive old`; do not edit.\n")
    (tmp_path / "mine.md").write_text("My own notes.\n")
    stale = dict(derivation_pages.check(tmp_path))
    assert {path.name for path in stale} == {"spherical_body.md", "planar_motion.md", "old.md"}
    assert "\n-**1.** No inertia tensor" in stale[tmp_path / "spherical_body.md"]
    assert "\n+**1.** The inertia tensor" in stale[tmp_path / "spherical_body.md"]
    assert {path.name for path in derivation_pages.derive_all(tmp_path)} == {path.name for path in stale}
    assert (
        derivation_pages.check(tmp_path) == []
        and (tmp_path / "mine.md").exists()
        and not (tmp_path / "old.md").exists()
    )


def test_a_page_does_not_depend_on_hashing(derived, printed):
    """The page is printed again in a process with another hash seed."""
    program = (
        "from symrot.catalogue import derivation; import sys; names = sys.argv[1:];"
        "sys.stdout.write(''.join(derivation(n).markdown() for n in names));"
        "sys.stdout.write(''.join(derivation(n).html() + derivation(n).part(2, True).markdown() for n in names))"
    )
    environment = os.environ | {"PYTHONHASHSEED": "20"}
    command = [sys.executable, "-c", program, *SPREAD]
    pages = subprocess.run(command, env=environment, capture_output=True, check=True).stdout.decode()
    here = "".join(derived[name].markdown() for name in SPREAD)
    here += "".join(derived[name].html() + derived[name].part(2, True).markdown() for name in SPREAD)
    assert pages == here


def test_what_was_asked_for_is_there(derived):
    assert set(ASKED.values()) <= set(derived)
    assert sum(len(found.steps) for found in derived.values()) > 650


def test_all_is_printed_as_html_that_is_well_formed(site):
    for path in site.glob("*.html"):
        name, page = path.stem, path.read_text(encoding="utf-8")
        html = re.sub(r"<!DOCTYPE html>\n|<meta [^>]*>|<input [^>]*>", "", page)
        tree = ElementTree.fromstring(html)
        assert not re.search("https?:(?!//www.w3.org/(1998/Math/MathML|2000/svg))", page), name
        if name == "index":
            continue
        source = derivation_pages.printed_page(name)
        places = {element.get("id") for element in tree.iter()}
        sections = tree.findall(".//section")
        assert len(sections) == sum(isinstance(item, Step) for item in source.items), name
        assert {f"step-{source.first + n}" for n in range(len(sections))} <= places, name
        formulas = {text for element in tree.iter() if "}m" in element.tag for text in element.itertext()}
        assert set("".join(formulas)) - {"\n"} <= characters(), name
        text = "".join(tree.itertext())
        assert "\\" not in text and "$" not in text, name


def test_all_is_printed_as_latex_with_balanced_braces(derived):
    for name, found in derived.items():
        text = found.latex()
        bare = text.replace("\\{", "").replace("\\}", "")
        assert bare.count("{") == bare.count("}"), name
        assert text.count(r"\left") - text.count(r"\leftarrow") == text.count(r"\right") - text.count(r"\rightarrow"), (
            name
        )


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="needs pdflatex")
def test_tables_of_long_formulas_compile(tmp_path):
    names = ("euler_singularities", "intermediate_axis")
    pages = {"First": [catalogue.derivation(name) for name in names]}
    (tmp_path / "book.tex").write_text(latex_book("Bodies", "About.", pages), encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "book.tex"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and "Overfull" not in done.stdout, done.stdout[-2000:]


def test_all_pages_can_be_written_as_html(derived, site, tmp_path):
    files = {path.name for path in site.iterdir()}
    appendices = {f"{name}{APPENDIX}" for name in derived if LESSONS[name].library}
    assert files == {f"{name}.html" for name in {*derived} | appendices} | {"index.html", "search.js", "math.woff2"}
    for path in site.glob("*.html"):
        for target in re.findall(r'href="([^"#]+)"', path.read_text()):
            assert (site / target).exists(), (path.name, target)
    with pytest.raises(InputError, match=r"latex or html, got 'pdf'"):
        derivation_pages.write_pages(tmp_path, "pdf")


def test_a_handout_has_the_chosen_pages_and_no_dead_links(tmp_path, capsys):
    chosen = ["intermediate_axis", "spherical_body"]
    for form in ("html", "latex", "markdown"):
        assert main(["derive", *chosen, "--format", form, "-o", str(tmp_path / form)]) == 0
    written = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.is_file()}
    assert written == {Path(line).relative_to(tmp_path).as_posix() for line in capsys.readouterr().out.split()}
    assert {"html/index.html", "latex/book.tex", "latex/spherical_body.tex", "markdown/spherical_body.md"} <= written
    for form, pattern in (("html", r'href="([^"#]+)"'), ("markdown", r"\]\(([^)#]+)\)")):
        for path in (tmp_path / form).glob("*.*"):
            for target in re.findall(pattern, path.read_text()) if path.suffix in (".html", ".md") else ():
                assert (tmp_path / form / target).exists(), (path.name, target)


def test_a_handout_links_to_pages_that_are_there_already(tmp_path):
    """A page that is printed again among all pages keeps its links."""
    printed = derivation_pages.illustrated(catalogue.derivation("intermediate_axis")).markdown()
    for name in re.findall(r"\]\((\w+)\.md\)", printed):
        (tmp_path / f"{name}.md").touch()
    derivation_pages.write_handout(tmp_path, "markdown", ["intermediate_axis"])
    assert (tmp_path / "intermediate_axis.md").read_text(encoding="utf-8") == printed


def test_the_latex_book_has_parts_chapters_and_links():
    text = latex_book("Bodies", "About.", {"First": [catalogue.derivation("intermediate_axis")],
                                           "Last": [catalogue.derivation("euler_singularities")]})  # fmt: skip
    assert text.count(r"\part{") == 2 and text.count(r"\chapter{") == 2 and r"\tableofcontents" in text
    assert r"\pagelink{euler_body_rates}{all sequences}" in text and text.count(r"\begin{document}") == 1
    assert text.count(r"\begin{longtable}") == text.count(r"\end{longtable}") == 2


def test_bold_words_are_bold_in_latex():
    page = Page("page", "Page", about="**Is $x^2$ positive?** The code `x**2` and `y**2`, *yes*.")
    assert (
        r"\textbf{Is $x^2$ positive?} The code \texttt{x**\allowbreak{}2} and \texttt{y**\allowbreak{}2}, \emph{yes}."
        in latex_document(page)
    )


def test_a_command_can_be_copied_from_latex():
    page = Page("page", "Page", about="Try `symrot check 'x == 1' --given 'x > 0'`, with x in kg m^2.")
    text = latex_document(page)
    assert r"check \textquotesingle{}x == 1\textquotesingle{} -{}-given" in text and r"m\textsuperscript{2}" in text


def test_a_long_formula_in_a_sentence_is_displayed_in_latex():
    long = " + ".join(f"x_{{{n}}}" for n in range(30))
    text = latex_document(Page("page", "Page", about=f"It is ${long}$. And $x$, too."))
    assert rf"It is \fitted{{{long}.}} And $x$, too." in text


def test_a_proof_on_the_board_fits_on_a_screen(derived):
    assert sum(bool(step.board) for page in derived.values() for step in page.steps) > 40
    for page in derived.values():
        for number, step in enumerate(page.steps, 1):
            if step.board:
                detail = page.part(number, True).latex().split(r"\section*{In detail}")[1]
                lines = detail.split(r"\paragraph{Units}")[0].split(r"\medskip")[0].strip().count("\n") + 1
                assert lines <= 33, (page.name, number)


def test_links_lead_to_pages(printed):
    for name, text in printed.items():
        for target in re.findall(r"\]\(([^)#]+)\)", text):
            assert target in printed, (name, target)


@pytest.mark.parametrize("form, start", [("markdown", "# "), ("latex", r"\documentclass"), ("html", "<!DOCTYPE html>")])
def test_one_step_on_the_command_line(form, start, capsys):
    assert main(["derive", "heavy_top", "--step", "3", "--detail", "--format", form]) == 0
    text = capsys.readouterr().out
    assert text.startswith(start) and "step 3" in text and "In detail" in text
    assert main(["derive", "heavy_top", "--step", "3", "--format", form]) == 0
    assert "In detail" not in capsys.readouterr().out


@pytest.mark.parametrize(
    "words, complaint",
    [
        (["heavy_top", "--step", "99"], "a step from 1 to 17, got 99"),
        (["heavy_top", "--detail"], "--detail needs --step N"),
        (["heavy_top", "-o", "page.html"], "write --format html -o DIR"),
        (["heavy_top", "--step", "1", "-o", "pages"], "leave out -o DIR"),
        (["heavy_top", "poinsot"], "several NAMEs need a folder for their pages, -o DIR"),
        (["heavy_top", "poinsod", "-o", "no_such"], "'poinsod' (did you mean 'poinsot'?"),
        (["--step", "2"], "expected a NAME"),
        (["--all", "--step", "2"], "expected a NAME"),
        (["heavy_top", "--step", "two"], "invalid int"),
        (["--all", "--format", "html"], "expected a folder, -o DIR"),
        (["--check", "--format", "latex"], "--check compares Markdown pages only"),
        (["--all", "-o", __file__], "expected -o with a folder for the pages, got the file"),
        (["--all", "--format", "html", "-o", __file__], "expected -o with a folder for the pages, got the file"),
        (["poinsot", "-o", __file__], "expected -o with a folder for the pages, got the file"),
        (["poinsot_appendix"], "free_body_attitude_appendix"),
    ],
)
def test_a_page_that_cannot_be_printed_is_refused(words, complaint, capsys):
    assert main(["derive", *words]) == 2
    assert complaint in capsys.readouterr().err


def test_an_appendix_is_printed_by_its_name(capsys):
    assert main(["derive", "elliptic_functions_appendix"]) == 0
    text = capsys.readouterr().out
    assert "**4.** The functions" in text and "**3.**" not in text and "A common mistake" not in text
    assert main(["derive", "elliptic_functions_appendix", "--step", "4"]) == 0
    assert "**4.** The functions" in capsys.readouterr().out


@pytest.mark.parametrize("form", ["html", "latex", "markdown"])
def test_progress_is_shown_while_pages_are_written(form, tmp_path):
    lines = []
    derivation_pages.write_handout(tmp_path, form, ["spherical_body", "intermediate_axis"], lines.append)
    assert lines == ["1 of 2: deriving spherical_body", "2 of 2: deriving intermediate_axis"]


@pytest.mark.parametrize("form", ["html", "markdown"])
def test_an_unknown_name_is_refused_before_any_page_is_derived(form, tmp_path):
    lines = []
    with pytest.raises(InputError, match="did you mean 'poinsot'"):
        derivation_pages.write_handout(tmp_path, form, ["spherical_body", "poinsod"], lines.append)
    assert lines == []


def test_the_catalogue_is_named_without_sympy():
    program = "import sys, symrot.catalogue as c; c.names(); sys.exit('sympy' in sys.modules)"
    subprocess.run([sys.executable, "-c", program], check=True)


QUERIES = {  # what students type -> the page that answers
    "gimbal lock": "euler_singularities", "parallel axis": "parallel_axis", "Euler angles rates": "euler_body_rates",
    "intermediate axis": "intermediate_axis", "sleeping top": "sleeping_top", "Steiner": "parallel_axis",
    "moment of inertia of a cone": "standard_solids", "tennis racket theorem": "intermediate_axis",
    "wobble of the Earth": "symmetric_top", "quaternion multiplication": "quaternion_rates", "polhode": "poinsot",
    "rotation matrix": "rotation_matrices", "principal axes": "tensor_rotation", "bicycle wheel": "gyroscopic_wheel",
    "center of percussion": "impulse_and_momentum", "rolling without slipping": "rolling", "nutation": "heavy_top",
}  # fmt: skip


@pytest.mark.skipif(NODE is None, reason="needs Node.js")
def test_the_search_of_the_book_answers_what_students_type(printed):
    """``printed`` has derived all pages in this process."""
    pages = [derivation_pages.printed_page(name) for name in catalogue.names()]
    lists = pages_of(search_script(pages, OTHER_NAMES), *QUERIES)
    assert {query: names[0] for query, names in zip(QUERIES, lists, strict=True)} == QUERIES
