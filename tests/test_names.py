"""Names say what a thing is: no variable, argument, attribute or function is named by a participle such as ``found``."""

import ast
import re
from pathlib import Path

import pytest

import symrot

PACKAGE = Path(symrot.__file__).parent
PARTICIPLES = {"found", "given", "kept", "said", "shown", "spoken", "taken", "wanted"}
PARTICIPLE = re.compile(rf"\b_*(?:{'|'.join(PARTICIPLES)})_*\b", re.IGNORECASE)
STRING_OR_COMMENT = re.compile(
    r'''#[^\n]*|(?<![A-Za-z])([A-Za-z]{0,2})(?:"""[^"\\]*(?:(?:\\.|"(?!""))[^"\\]*)*"""'''
    r"""|"[^"\\\n]*(?:\\.[^"\\\n]*)*"|\'[^\'\\\n]*(?:\\.[^\'\\\n]*)*\')""",
    re.DOTALL,
)
ROOMS = tuple(sorted({path.name for path in PACKAGE.iterdir() if (path / "__init__.py").is_file()}))


def participles(source):
    """Return the names in Python source that are participles, with their lines."""
    if not PARTICIPLE.search(source):
        return
    # most sources have these words only in docstrings and comments, and need not be parsed
    code = STRING_OR_COMMENT.sub(lambda match: match[0] if "f" in (match[1] or "").lower() else "", source)
    if not PARTICIPLE.search(code):
        return
    for node in ast.walk(ast.parse(source)):
        names = {
            ast.Name: ("id",), ast.arg: ("arg",), ast.Attribute: ("attr",), ast.keyword: ("arg",),
            ast.FunctionDef: ("name",), ast.ClassDef: ("name",), ast.alias: ("name", "asname"),
        }.get(type(node), ())  # fmt: skip
        yield from (
            (getattr(node, "lineno", 0), getattr(node, name))
            for name in names
            if (getattr(node, name) or "").strip("_").lower() in PARTICIPLES
        )


@pytest.mark.parametrize("room", ROOMS)
def test_no_name_is_a_participle(room):
    files = sorted((PACKAGE / room).rglob("*.py"))
    names = {str(path.relative_to(PACKAGE)): [*participles(path.read_text(encoding="utf-8"))] for path in files}
    assert files and not {path: where for path, where in names.items() if where}


@pytest.mark.parametrize("source", [
    "found = 1", "for taken in (): pass", "def f(given): pass", "def shown(): pass", "lambda kept: 0", "f(wanted=1)",
    "x.said", "class A:\n    spoken: int = 0", "[found for found in ()]", "import a as _shown", "with a as kept: pass",
    "f'{found}'",
])  # fmt: skip
def test_a_participle_is_noticed(source):
    assert [*participles(source)]


def test_other_names_pass():
    assert [*participles("foundation, given_name = taken_together.showing(keep=1)")] == []
    assert [*participles("'found'  # kept\nx = 1")] == []
