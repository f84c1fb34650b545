"""Hashes of code: docstrings and comments do not change them, anything else does."""

import ast

import pytest

from symrot.build.code_digest import code_without_prose
from symrot.build.sources import PACKAGE

SOURCE = '''"""Sums of numbers."""

import math  # for pi


class Angle:
    """An angle."""

    def plus(self, x):
        """Return self + x.

        In radians.
        """
        # no remainder modulo 2*pi
        text = "# no comment"
        return self + x
'''


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"""Sums of numbers."""', '"""Sums of numbers,\n\nor of angles."""'),
        ('"""An angle."""', "'One angle.'  # in radians"),
        ('    """An angle."""', '    r"""An angle of 2\\pi."""  # radians'),
        ("In radians.\n", "In degrees.\n\n\n"),
        ("  # for pi", ""),
        ("        # no remainder modulo 2*pi\n", ""),
    ],
)
def test_docstrings_and_comments_are_no_part_of_the_code(old, new):
    assert old in SOURCE
    assert code_without_prose(SOURCE.replace(old, new)) == code_without_prose(SOURCE)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("self + x\n", "self - x\n"),
        ("# no comment", "# a comment"),
        ('"""An angle."""\n', '"""An angle.""".strip()\n'),
    ],
)
def test_operators_and_texts_are_parts_of_the_code(old, new):
    assert old in SOURCE
    assert code_without_prose(SOURCE.replace(old, new)) != code_without_prose(SOURCE)


def statements(tree):
    """Return the syntax tree as text, without statements that are only a constant."""
    for node in ast.walk(tree):
        if isinstance(body := getattr(node, "body", None), list):
            node.body = [s for s in body if not (isinstance(s, ast.Expr) and isinstance(s.value, ast.Constant))]
    return ast.dump(tree)


def test_the_code_keeps_its_syntax_tree():
    # in these rooms, no docstring is the whole body of a class or function
    for path in [path for room in ("rounding", "readback") for path in (PACKAGE / "certificates" / room).glob("*.py")]:
        source = path.read_text(encoding="utf-8")
        code = code_without_prose(source)
        assert statements(ast.parse(code)) == statements(ast.parse(source)), path
