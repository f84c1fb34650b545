"""Pages of derivations with their figures: printed, written to a folder, or compared with the files in a folder."""

import re
import shutil
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import fields
from difflib import unified_diff
from functools import cache
from pathlib import Path
from textwrap import wrap

from symrot.catalogue import READING_ORDER, derivation, names, require_name
from symrot.errors import InputError
from symrot.figures.table import figures_of
from symrot.files.reading import refuse_special
from symrot.lessons.other_names import OTHER_NAMES
from symrot.lessons.page import APPENDIX, appendix, taught
from symrot.lessons.table import LESSONS
from symrot.proof.derivation import PrintedPage
from symrot.proof.page import Figure, Page, Passage, Section, Step, Table
from symrot.proof.pages import book, latex_book, math_font

__all__ = [
    "check",
    "derivation_of",
    "derive_all",
    "illustrated",
    "pages",
    "printed_page",
    "write_handout",
    "write_pages",
]

Chapters = dict[str, list[PrintedPage]]
"""Chapter -> its pages, in reading order."""

TITLE = "Derivations"
ABOUT = (
    "Every formula that symrot computes with, from first principles, in reading order. Each step was proven when its "
    "page was printed: the exact normal form of left minus right is zero."
)

APPENDICES = "Appendices: for the numeric code"
"""The title of the last chapter, with the pages that a course can leave out."""

HANDOUT = "Handout"
ABOUT_HANDOUT = (
    "Derivations of symrot. Each step was proven when its page was printed: the exact normal form of left minus right "
    "is zero."
)

FEW_FIGURES = 3
"""A page with at most this many figures opens with its first figure, even if that figure belongs to a section."""

CONVERTER = "rsvg-convert"
"""The program that converts SVG to PDF for LaTeX; without it, LaTeX prints the caption of a figure alone."""

Say = Callable[[str], object]
"""A function that is called with a line of text about progress."""


def _quiet(text: str) -> None:
    """Ignore a message about progress; this is the default for the parameter ``say``."""


def illustrated(page: Page) -> PrintedPage:
    """Return a derivation's page with its figures and its lesson for students: question, numbers, a common mistake.

    Raises
    ------
    InputError
        If a figure names a section that the page does not have.

    Examples
    --------
    >>> import symrot
    >>> page = illustrated(symrot.derivation("poinsot"))
    >>> [item.name for item in page.opening if isinstance(item, Figure)][0]
    'poinsot'
    """
    # A figure is at the top of the page or below the heading of its section. A page with few figures and none at the
    # top shows its first figure there. Steps that only symrot's numeric code needs are left out.
    whole, top = _with_figures(page)
    return _printed(taught(whole, top))


def _with_figures(page: Page) -> tuple[Page, list[Figure]]:
    """Return a page with each figure below the heading of its section, and the figures for the top of the page."""
    figures = figures_of(page.name)
    by_section: dict[str, list[Figure]] = {}
    for figure in figures:
        by_section.setdefault(figure.section, []).append(figure)
    top = by_section.pop("", [])
    if not top and 0 < len(figures) <= FEW_FIGURES:
        top = [figures[0]]
        by_section[figures[0].section].remove(figures[0])
    items: list[Section | Passage | Step | Table | Figure] = []
    for item in page.items:
        items.append(item)
        if isinstance(item, Section):
            items += by_section.pop(item.title, ())
    if by_section:
        raise InputError(
            f"{page.name}: expected every figure in a section of this page, got figures for sections that the page "
            f"does not have: {', '.join(map(repr, by_section))}"
        )
    values = {each.name: getattr(page, each.name) for each in fields(Page)}
    return Page(**values | {"items": items}), top


def _printed(page: Page) -> PrintedPage:
    return PrintedPage(**{each.name: getattr(page, each.name) for each in fields(Page)})


def derivation_of(name: str) -> str:
    """Return the name of the derivation that a page belongs to.

    It is ``name`` without the ending ``_appendix``: ``driven_rotation`` for ``driven_rotation_appendix``.
    """
    return name.removesuffix(APPENDIX)


@cache
def printed_page(name: str) -> PrintedPage:
    """Return a page as it is printed; it is made once per process.

    Parameters
    ----------
    name : str
        The name of a derivation, for the lesson with its figures, or that name with the ending ``_appendix``, for the
        steps of the derivation that only symrot's numeric code needs.

    Raises
    ------
    InputError
        If there is no such derivation, or if it has no appendix.

    Examples
    --------
    >>> printed_page("driven_rotation_appendix").title
    'Constant torque and damping about one axis: for the numeric code'
    """
    if not name.endswith(APPENDIX):
        return illustrated(derivation(name))
    rest = appendix(_with_figures(derivation(derivation_of(name)))[0])
    if rest is None:
        raise InputError(
            f"expected one of the appendices (pages with the steps that only numeric code needs), "
            f"{', '.join(_appendices(names()))}, got {name!r}"
        )
    return _printed(rest)


def _page_names() -> tuple[str, ...]:
    """Return the names of all pages: the derivations in reading order, and their appendices in the same order."""
    return (*names(), *_appendices(names()))


def _appendices(derivations: Sequence[str]) -> list[str]:
    """Return the names of the appendices that some of the ``derivations`` have, in the same order."""
    return [f"{name}{APPENDIX}" for name in derivations if LESSONS[name].library]


def _chapters(chosen: Sequence[str]) -> dict[str, list[str]]:
    """Return a map from the title of each chapter to the names of its pages that are in ``chosen``."""
    whole = READING_ORDER | {APPENDICES: _appendices(names())}
    chapters = {title: [name for name in members if name in chosen] for title, members in whole.items()}
    return {title: members for title, members in chapters.items() if members}


def pages(say: Say = _quiet) -> dict[str, str]:
    """Return the pages of all derivations in Markdown, and their figures in SVG, as a map from file name to text.

    The first file is ``README.md``, the table of contents.
    """
    derived = _derived(_page_names(), say)
    lines = [
        f"# {TITLE}",
        "",
        *wrap(ABOUT, 110, break_on_hyphens=False),
    ]
    for part, members in _chapters(_page_names()).items():
        lines += ["", f"## {part}", ""]
        lines += [f"- [{derived[name].title}]({name}.md), {derived[name].extent}" for name in members]
    lines += ["", "Printed by `symrot derive --all`; do not edit.", ""]
    texts = {"README.md": "\n".join(lines)} | {f"{name}.md": page.markdown() for name, page in derived.items()}
    return texts | {figure.file: figure.svg() for page in derived.values() for figure in _figures(page)}


def _derived(chosen: Sequence[str], say: Say) -> dict[str, PrintedPage]:
    """Return a map from name to page; ``say`` is called with a line of text before each page is derived.

    InputError is raised for an unknown name before the first page is derived.
    """
    for name in chosen:
        require_name(derivation_of(name))
    derived = {}
    for number, name in enumerate(chosen, 1):
        say(f"{number} of {len(chosen)}: deriving {name}")
        derived[name] = printed_page(name)
    return derived


def _figures(page: Page) -> list[Figure]:
    return [item for item in [*page.opening, *page.items] if isinstance(item, Figure)]


def write_pages(directory: Path | str, form: str, chosen: Sequence[str] = (), say: Say = _quiet) -> list[Path]:
    """Write derivations into a directory, as documents of LaTeX or as a book in HTML, and return the paths.

    Parameters
    ----------
    directory : Path or str
        The directory, which is created if it does not exist.
    form : str
        ``"latex"`` or ``"html"``.
    chosen : sequence of str
        Names of pages (see :func:`printed_page`); all if empty. A book has them in reading order, whatever their order
        here.
    say : callable
        Called with a line of text about progress before each derivation.

    Raises
    ------
    InputError
        For an unknown format or an unknown derivation.
    """
    if form not in FORMS:
        raise InputError(f"form: expected {' or '.join(FORMS)}, got {form!r}")
    derived = _derived(chosen or _page_names(), say)
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    chapters = {chapter: [derived[name] for name in members] for chapter, members in _chapters([*derived]).items()}
    if chosen:
        chapters = {"": [page for members in chapters.values() for page in members]}
    written = []
    # index.html is the start of the book; with LaTeX each page is a document, and book.tex has all of them
    for name, content in FORMS[form](*((HANDOUT, ABOUT_HANDOUT) if chosen else (TITLE, ABOUT)), chapters).items():
        path = directory / name
        path.write_bytes(content)
        written.append(path)
    # figures in LaTeX are PDF files in the folder figures
    if form == "latex" and shutil.which(CONVERTER):
        figures = [figure for members in chapters.values() for page in members for figure in _figures(page)]
        written += _converted(directory, figures)
    return written


def write_handout(directory: Path | str, form: str, chosen: Sequence[str], say: Say = _quiet) -> list[Path]:
    """Write a few derivations into a directory, for students, and return the paths.

    In Markdown and HTML, a link to a page that is neither chosen nor in the directory becomes plain text.

    Parameters and exceptions are those of :func:`write_pages`; ``form`` may also be ``"markdown"``.
    """
    if form != "markdown":
        paths = write_pages(directory, form, chosen, say)
        present = _present(Path(directory), chosen, ".html")
        for path in paths if form == "html" else ():
            if path.suffix == ".html":
                path.write_bytes(_only_links_to(present, LINK_IN_HTML, path.read_bytes().decode()).encode())
        return paths
    directory = Path(directory)
    present = _present(directory, chosen, ".md")
    written = []
    texts: dict[str, str] = {}
    for name, page in _derived(chosen, say).items():
        texts[f"{name}.md"] = _only_links_to(present, LINK, page.markdown())
        texts |= {figure.file: figure.svg() for figure in _figures(page)}
    for file, text in texts.items():
        path = directory / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode())
        written.append(path)
    return written


LINK = re.compile(r"\[(?P<label>[^\]]+)\]\((?P<page>\w+)\.md\)")
"""Regular expression of a link to another page in Markdown."""

LINK_IN_HTML = re.compile(r'<a href="(?P<page>\w+)\.html">(?P<label>.*?)</a>')
"""Regular expression of a link to another page in HTML."""


def _present(directory: Path, chosen: Sequence[str], suffix: str) -> set[str]:
    """Return the names of the ``chosen`` pages and of those whose files (name and ``suffix``) are in ``directory``."""
    return {name for name in _page_names() if name in chosen or (directory / f"{name}{suffix}").is_file()}


def _only_links_to(present: set[str], link: re.Pattern[str], text: str) -> str:
    """Return ``text`` with each link to a page that is not in ``present`` replaced by the words of the link.

    ``link`` matches a link, with the groups "page" and "label".
    """
    missing = set(_page_names()) - present
    return link.sub(lambda match: match["label"] if match["page"] in missing else match[0], text)


def _html(title: str, about: str, chapters: Chapters) -> dict[str, bytes]:
    return _encoded(book(title, about, chapters, OTHER_NAMES)) | {math_font.FILE: math_font.content()}


def _latex(title: str, about: str, chapters: Chapters) -> dict[str, bytes]:
    documents = {f"{page.name}.tex": page.latex() for members in chapters.values() for page in members}
    return _encoded({"book.tex": latex_book(title, about, chapters)} | documents)


def _encoded(texts: dict[str, str]) -> dict[str, bytes]:
    return {name: text.encode() for name, text in texts.items()}


FORMS: dict[str, Callable[[str, str, Chapters], dict[str, bytes]]] = {"latex": _latex, "html": _html}
"""Format of all pages, other than Markdown -> function that returns the contents of the files.

Its arguments are the title, the paragraph below the title, and the pages of each chapter.
"""


def _converted(directory: Path, figures: list[Figure]) -> list[Path]:
    """Convert figures to PDF files in ``directory`` with the program :data:`CONVERTER`; return their paths."""
    paths = []
    for figure in figures:
        path = (directory / figure.file).with_suffix(".pdf")
        path.parent.mkdir(exist_ok=True)
        command = [CONVERTER, "--format", "pdf", "--output", str(path)]
        subprocess.run(command, input=figure.svg().encode(), check=True)
        paths.append(path)
    return paths


def derive_all(directory: Path | str, say: Say = _quiet) -> list[Path]:
    """Write every page and figure into a directory; return the paths of the files that changed or were deleted."""
    directory = Path(directory)
    (directory / "figures").mkdir(parents=True, exist_ok=True)
    changed = []
    printed = pages(say)
    for name, text in printed.items():
        path = directory / name
        if not path.is_file() or path.read_bytes() != text.encode():
            if path.exists():
                refuse_special(path)  # a pipe would wait for a reader
            path.write_bytes(text.encode())
            changed.append(path)
    # pages and figures that are no longer in the catalogue; other files are not touched
    for path in _left_over(directory, printed):
        path.unlink()
        changed.append(path)
    return changed


def check(directory: Path | str, say: Say = _quiet) -> list[tuple[Path, str]]:
    """Return (path, unified diff) for each page or figure in a directory that differs from what is printed now."""
    directory = Path(directory)
    printed = pages(say)
    stale = []
    for path in [*(directory / name for name in printed), *_left_over(directory, printed)]:
        old = path.read_bytes().decode(errors="replace") if path.is_file() else ""
        new = printed.get(path.relative_to(directory).as_posix(), "")
        if old != new:
            lines = unified_diff(
                old.splitlines(keepends=True), new.splitlines(keepends=True), f"{path} (on disk)", f"{path} (derived)"
            )
            stale.append((path, "".join(lines)))
    return stale


def _left_over(directory: Path, printed: dict[str, str]) -> list[Path]:
    """Return the files that symrot printed into a directory earlier and that are not in ``printed`` now."""
    files = [*sorted(directory.glob("*.md")), *sorted(directory.glob("figures/*.svg"))]
    others = (path for path in files if path.relative_to(directory).as_posix() not in printed and path.is_file())
    return [path for path in others if _mark(path).encode() in path.read_bytes()]


def _mark(path: Path) -> str:
    """Return words that symrot prints into every page or figure, by which it recognises a file as its own."""
    if path.suffix == ".svg":
        return 'xmlns="http://www.w3.org/2000/svg" class="sf'
    return f"printed by `symrot derive {path.stem}`; do not edit."
