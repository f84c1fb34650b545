"""Hooks of mkdocs: add the printed pages to the site, and turn their LaTeX into MathML.

The documents link to files outside ``docs/`` by the paths that work in the repository, such as
``../derivations/poinsot.md``. The hooks add those files to the site and shorten the links.
"""

import re
from pathlib import Path
from typing import Any

from symrot.proof.notation.mathml import mathml

ROOT = Path(__file__).parents[1]
ADDED = ("CONTRIBUTING.md", "CHANGELOG.md", "derivations/*.md", "derivations/figures/*.svg", "generated/errata.md",
         "generated/*.png", "generated/bench/suite.md", "generated/bench/*.png")  # fmt: skip
DISPLAY = re.compile(r"^\$\$\n(.*?)\n\$\$$", re.DOTALL | re.MULTILINE)
INLINE = re.compile(r"\$`([^`]+)`\$|\$([^$\n]+)\$")


def on_files(files: Any, config: Any) -> Any:
    """Add the files outside ``docs/`` that the documents link to."""
    from mkdocs.structure.files import File

    for pattern in ADDED:
        for path in sorted(ROOT.glob(pattern)):
            files.append(File.generated(config, path.relative_to(ROOT).as_posix(), abs_src_path=str(path)))
    return files


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    """Return the text of a page with links inside the site and formulas in MathML."""
    if "/" not in page.file.src_uri:
        markdown = re.sub(r"\]\((?:\.\./|docs/)", "](", markdown)
    if page.file.src_uri.startswith("derivations/"):
        markdown = with_mathml(markdown)
    return markdown


def with_mathml(markdown: str) -> str:
    """Return a page with its LaTeX formulas as MathML, which browsers show without a script."""
    markdown = DISPLAY.sub(lambda match: f"<div>{mathml(match[1], display=True)}</div>", markdown)
    return INLINE.sub(lambda match: mathml(match[1] or match[2]), markdown)


def conventions_text(docstring: str) -> str:
    """Return the definitions in the docstring of ``symrot/conventions.py`` as Markdown: one bullet for each."""
    bullets: list[str] = []
    for line in docstring.splitlines()[1:]:
        if line and not line.startswith(" "):
            bullets.append(f"- **{line}.**")
        elif line.strip():
            bullets[-1] += f"\n  {line.strip()}"
    text = "\n".join(bullets).replace("``", "`")
    return re.sub(r":mod:`([^`]*)`", r"`\1`", text)
