"""Every name with external linkage in symrot's C begins with ``symrot_``, so that the C can be linked with any program."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCES = sorted(
    path
    for folder in ("symrot", "generated/c", "tests/reference")
    for path in (ROOT / folder).rglob("*.[ch]")
)  # fmt: skip
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
STATIC = re.compile(r"#\s*define\s+(\w+)\s+static\b")
DEFINITION = re.compile(
    r"^(?!#|typedef|return|else)((?:\w+[ *]+)+)(\w+)\s*(?:\([^;{}]*\)\s*\{|(?:\[[^]]*\])*\s*(?:=|;))", re.M
)


def external_names(text, internal):
    """Return the functions and variables of a C text that other files can see."""
    definitions = DEFINITION.findall(COMMENT.sub(" ", text))
    return [
        name
        for kind, name in definitions
        if not {"static", "extern", "typedef", *internal} & {*kind.replace("*", " ").split()}
    ]


def internal_words():
    """Return the macros that begin with static."""
    return {word for path in SOURCES for word in STATIC.findall(path.read_text(encoding="utf-8"))}


def test_external_names_begin_with_symrot():
    internal = internal_words()
    assert {"STAGE", "SYMROT_INLINE"} <= internal
    names = {
        (path.name, name) for path in SOURCES for name in external_names(path.read_text(encoding="utf-8"), internal)
    }
    assert len(names) > 900
    assert [each for each in sorted(names) if not each[1].startswith("symrot_")] == []


@pytest.mark.parametrize(
    "text, names",
    [
        ("void f(double x)\n{\n}\n", ["f"]), ("int count = 3;\n", ["count"]), ("const double table[2] = {1, 2};\n", ["table"]),
        ("static double f(void)\n{\n}\n", []), ("STAGE f(\n    double x)\n{\n    y = 3;\n}\n", []), ("/* void f(void) { */\n", []),
        ("void f(double x);\n", []), ("double *g(size_t n)\n{\n    return 0;\n}\n", ["g"]),
    ],
)  # fmt: skip
def test_the_reader_of_names_sees_what_a_linker_sees(text, names):
    assert external_names(text, {"STAGE"}) == names


def test_the_linker_agrees(tmp_path):
    """The symbols in a kernel's object file are those that its text defines."""
    source = ROOT / "generated" / "c" / "heavy_top.c"
    target = tmp_path / "heavy_top.o"
    subprocess.run(["cc", "-std=c99", "-c", str(source), "-o", str(target)], check=True)
    listing = subprocess.run(["nm", "--defined-only", "-g", str(target)], check=True, capture_output=True, text=True)
    symbols = [line.split()[-1] for line in listing.stdout.splitlines()]
    assert sorted(symbols) == sorted(external_names(source.read_text(encoding="utf-8"), internal_words()))
