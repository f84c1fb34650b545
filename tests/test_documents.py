"""The documents are true: every code block runs and prints what the page shows, and every link leads somewhere."""

import inspect
import json
import re
import sys
from contextlib import redirect_stdout
from functools import cache
from importlib.util import find_spec
from io import StringIO
from pathlib import Path

import pytest

import symrot.conventions
from symrot.catalogue import names as derivation_names
from symrot.cli.main import COMMANDS, main
from symrot.dynamics.torque_kinds import TABLE_KIND, TORQUE_KINDS
from symrot.inertia.shapes import SHAPES
from symrot.kernels.library import kernel_names
from symrot.propagation.method import METHODS
from symrot.scene.tables import QUANTITIES
from tests.code_blocks import Block, agree, blocks, run_block
from tests.needs import needs_compiler
from tests.test_package import ORDER

ROOT = Path(__file__).parents[1]
PAGES = {
    str(path.relative_to(ROOT)): path.read_text(encoding="utf-8")
    for path in (*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md")))
}
NOT_RUN = {  # page -> blocks that no test runs, since they install something, take minutes or need an optional package
    "README.md": 2,
    "CONTRIBUTING.md": 6,
    "docs/engineers.md": 6,
    "docs/sweeps.md": 5,
    "docs/teachers.md": 1,
}
DRAWINGS = {"docs/architecture.md": 4}  # page -> drawings in plain text
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"^```.*?^```$|`[^`\n]*`", re.DOTALL | re.MULTILINE)
CITED = re.compile(r"\b(?:docs/\w+|[A-Z_]{4,})\.md\b")  # printed pages have names in small letters
SOURCES = {".py", ".c", ".h", ".toml"}
SCENES = PAGES["docs/scene_format.md"]


@needs_compiler
@pytest.mark.usefixtures("quick_compiler")
@pytest.mark.parametrize("page", PAGES)
def test_the_code_runs_and_prints_what_the_page_shows(page, tmp_path, monkeypatch):
    for folder in ("generated", "derivations", "tests"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "110")
    names = {}
    for block in blocks(PAGES[page]):
        if not block.runs:
            continue
        printed = run_block(block, names, tmp_path)
        if block.output is not None:
            assert agree(block.output, printed), f"{page}, line {block.line}, prints\n{printed}"


@pytest.mark.parametrize(("directives", "counts"), [(("not run", "test command"), NOT_RUN), (("diagram",), DRAWINGS)])
def test_blocks_that_are_not_run_are_counted(directives, counts):
    found = {page: sum(block.directive in directives for block in blocks(text)) for page, text in PAGES.items()}
    assert {page: count for page, count in found.items() if count} == counts


def test_the_test_command_is_where_ci_reads_it():
    assert [block.line for block in blocks(PAGES["README.md"]) if block.directive == "test command"]
    assert "<!-- test command -->\n```sh\npython3 -m venv" in PAGES["README.md"]


@pytest.mark.parametrize(
    ("shown", "printed", "good"),
    [
        ("a 1.00000000001\n", "a 1.00000000002\n", True),
        ("a 1.0001\n", "a 1.0002\n", False),
        ("drift 1.0e-15\n", "drift 3.3e-16\n", True),
        ("drift 1.0e-15\n", "drift 1.0e-9\n", False),
        ("3 steps\n", "4 steps\n", False),
        ("  cost   no steps, 120 us; ready in 2.1 s\n", "  cost  no steps, 3 ms; ready in 9 ms\n", True),
        ("takes 120 us\n", "takes 130 us\n", False),
        ("a\n...\nc\n", "a\nb\nb\nc\n", True),
        ("a\n...\nc\n", "a\nb\n", False),
        ("a\n", "a\nb\n", False),
        ("a\nb\n", "a\n", False),
    ],
)
def test_other_output_is_noticed(shown, printed, good):
    assert agree(shown, printed) == good


def test_a_command_with_another_exit_code_is_noticed(tmp_path):
    with pytest.raises(AssertionError, match="exit code 1, expected 0"):
        run_block(Block("sh", "symrot check 'x == y' --no-repair\n", 1), {}, tmp_path)
    with pytest.raises(AssertionError, match="exit code 3"):
        run_block(Block("sh", "python -c 'raise SystemExit(3)'\n", 1), {}, tmp_path)


def test_a_block_of_an_unknown_kind_is_noticed(tmp_path):
    with pytest.raises(ValueError, match="needs a comment"):
        run_block(Block("text", "no output of anything\n", 1), {}, tmp_path)


def anchors(text):
    """Return the anchors of a page's headings."""
    headings = re.findall(r"^#+ (.*)$", CODE.sub(lambda match: match[0].strip("`"), text), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}


def broken_links(page, text):
    """Return a page's links to missing files or headings of the repository."""
    for link in LINK.findall(CODE.sub("", text)):
        if not link.startswith("https://"):
            path, _, anchor = link.partition("#")
            target = (ROOT / page).parent / path
            if not target.exists() or (anchor and anchor not in anchors(target.read_text("utf-8") if path else text)):
                yield link


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page):
    assert list(broken_links(page, PAGES[page])) == []


def test_broken_links_are_noticed():
    text = "# Here\n[a](docs/limits.md) [b](docs/nothing.md) [c](#here) [d](#there) [e](docs/limits.md#nowhere)"
    assert list(broken_links("README.md", text)) == ["docs/nothing.md", "#there", "docs/limits.md#nowhere"]


def dangling(text):
    """Return the documents that a text cites and the repository lacks."""
    return [name for name in CITED.findall(text) if not (ROOT / name).exists()]


def test_every_document_that_the_code_cites_is_in_the_repository():
    files = [path for folder in ("symrot", "tests") for path in (ROOT / folder).rglob("*") if path.suffix in SOURCES]
    cited = {
        str(path.relative_to(ROOT)): names
        for path in files
        if path != Path(__file__) and (names := dangling(path.read_text(encoding="utf-8")))
    }
    assert cited == {}


def test_dangling_citations_are_noticed():
    assert dangling("see DESIGN.md, docs/limits.md, docs/nothing.md and README.md") == ["DESIGN.md", "docs/nothing.md"]


def test_every_shape_torque_and_quantity_is_named():
    for name in [*SHAPES, *TORQUE_KINDS, TABLE_KIND.kind, *QUANTITIES]:
        assert f"`{name}`" in SCENES, name


def test_the_dimensions_of_each_shape_are_those_of_the_code():
    table = SCENES.partition("| shape | dimensions, m |")[2].partition("##")[0]
    rows = dict(re.findall(r"^\| `(\w+)` \| ([a-z, ()]+) \|$", table, re.MULTILINE))
    assert {name: re.sub(r" \(.*?\)", "", row).split(", ") for name, row in rows.items()} == {
        name: [dimension.name for dimension in shape.dimensions] for name, shape in SHAPES.items()
    }


def test_every_command_and_method_has_its_entry():
    assert re.findall(r"^### `symrot (\w+)", PAGES["docs/commands.md"], re.MULTILINE) == list(COMMANDS)
    for name in set(METHODS) - {"auto", "constant", "scipy"}:
        assert f"| `{name}` |" in PAGES["docs/engineers.md"], name


@pytest.mark.parametrize("page", PAGES)
def test_every_module_that_a_page_runs_is_there(page):
    for module in re.findall(r"python -m ((?:symrot|tests)[\w.]*\w)", PAGES[page]):
        assert find_spec(module), module


@pytest.mark.parametrize("page", PAGES)
def test_every_command_and_option_that_a_page_names_is_there(page):
    for command, rest in re.findall(r"`symrot ([a-z]+)([^`\n]*)`", PAGES[page]):
        assert command in COMMANDS or command == "COMMAND", command
        for option in re.findall(r"(?<=\s)--?[a-z][a-z-]*", rest):
            assert option in usage(command), f"symrot {command} {option}"


@cache
def usage(command):
    """Return the help text of a command."""
    with redirect_stdout(StringIO()) as printed, pytest.raises(SystemExit):
        main([command, "--help"])
    return printed.getvalue()


def test_the_rooms_are_in_the_order_of_their_imports():
    table = PAGES["docs/architecture.md"].partition("| room |")[2].partition("##")[0]
    rooms = re.findall(r"`symrot/(\w+)(?:/|\.py)`", table)
    assert sorted([*rooms, "__main__"]) == sorted(ORDER)
    assert rooms == sorted(rooms, key=ORDER.__getitem__)


def test_counts_in_the_documents_are_those_of_the_package():
    assert "45 lessons" in PAGES["README.md"] and len(derivation_names()) == 45
    assert "library of 232 kernels" in PAGES["docs/engineers.md"] and len(kernel_names()) == 232


def test_the_table_of_proofs_is_that_of_the_certificates():
    certificates = [json.loads(path.read_text("utf-8")) for path in sorted((ROOT / "generated/c").glob("*.cert.json"))]
    assert len(certificates) == 232
    assert all(each["laws"] and each["readback"] and each["rounding"] for each in certificates)
    assert f"| {sum(bool(each['coq']) for each in certificates)} kernels: Euler" in PAGES["docs/certificates.md"]


def test_cited_sections_on_exact_decisions_are_there():
    sections = re.findall(r"^## (\d+)\. ", PAGES["docs/exact_decisions.md"], re.MULTILINE)
    assert sections == [str(number) for number in range(1, len(sections) + 1)]
    cited = [
        int(number)
        for path in (ROOT / "symrot").rglob("*.py")
        for numbers in re.findall(r"exact_decisions\.md``,\s+sections? (\d)(?: to (\d))?", path.read_text("utf-8"))
        for number in numbers
        if number
    ]
    assert cited and max(cited) <= len(sections)


def test_conventions_are_written_once():
    sys.path.insert(0, str(ROOT / "docs"))
    try:
        from site_hooks import conventions_text
    finally:
        sys.path.pop(0)
    text = conventions_text(inspect.cleandoc(symrot.conventions.__doc__))
    assert f"<!-- conventions -->\n{text}\n<!-- end of conventions -->" in PAGES["docs/conventions.md"]
