"""The tree says how a formula is written, with the place of every piece; bad LaTeX is refused with its place."""

from itertools import pairwise

import pytest

from symrot.errors import InputError
from symrot.latex.cursor import Cursor
from symrot.latex.reader import read
from symrot.latex.tokens import Token, tokens
from symrot.latex.tree import (
    Accent,
    Delimited,
    Font,
    Fraction,
    Root,
    Row,
    Script,
    Scripts,
    Table,
    alone,
    divided,
)


def shape(node):
    """Return a tree as nested tuples, without positions."""
    if isinstance(node, Token):
        return node.text
    if isinstance(node, Row):
        return [shape(item) for item in node.items]
    if isinstance(node, Scripts):
        return (shape(node.base), *((script.text, shape(script.inside)) for script in node.scripts))
    if isinstance(node, Fraction):
        return ("frac", shape(node.above), shape(node.below))
    if isinstance(node, Root):
        return ("root", node.index and shape(node.index), shape(node.inside))
    if isinstance(node, Accent | Font):
        return (node.text, shape(node.inside))
    if isinstance(node, Delimited):
        return (node.opening.text, shape(node.inside), node.closing.text)
    assert isinstance(node, Table)
    return (node.name, *([shape(cell) for cell in line] for line in node.lines))


SHAPES = (
    (r"x_1^2", [("x", ("_", "1"), ("^", "2"))]),
    (r"x^2_1", [("x", ("_", "1"), ("^", "2"))]),
    (r"f''_{ab}", [("f", ("'", "''"), ("_", ["a", "b"]))]),
    (r"f^{\prime\prime} g^\prime", [("f", ("'", "''")), ("g", ("'", "'"))]),
    (r"x^12", [("x", ("^", "1")), "2"]),
    (r"\frac12 \dfrac{a}{b}", [("frac", "1", "2"), ("frac", ["a"], ["b"])]),
    (r"\sqrt[3]{x} \sqrt y", [("root", ["3"], ["x"]), ("root", None, "y")]),
    (r"\left( a \right|_0", [(("(", ["a"], "|"), ("_", "0"))]),
    (r"\bigl( a \Big)", ["(", "a", ")"]),
    (r"\dot\theta_1 \hat{\mathbf n}", [((r"\dot", r"\theta"), ("_", "1")), (r"\hat", [(r"\mathbf", "n")])]),
    (r"\begin{array} {cc} a & b \\ c & d \\ \end{array}", [("array", [["a"], ["b"]], [["c"], ["d"]])]),
    (r"\begin{aligned} a &= b \\ &= c \end{aligned}", [("aligned", [["a"], ["=", "b"]], [[], ["=", "c"]])]),
    (r"\cos^{-1} c_\theta = \iiint \, dV", [
        (r"\cos", ("^", ["-", "1"])), ("c", ("_", r"\theta")), "=", r"\iiint", r"\,", "d", "V"]),
    (r"\int\limits_0^1 x", [(r"\int", ("_", "0"), ("^", "1")), "x"]),
    ("a % a comment\n b", ["a", "% a comment", "b"]),
    (r"] a ) | &", ["]", "a", ")", "|", "&"]),
)  # fmt: skip


@pytest.mark.parametrize(("latex", "tree"), SHAPES, ids=[latex[:30] for latex, _ in SHAPES])
def test_the_tree_is_the_formula_as_it_is_written(latex, tree):
    assert shape(read(latex)) == tree


@pytest.mark.parametrize("latex", [latex for latex, _ in SHAPES])
def test_every_item_starts_at_its_place(latex):
    """The source, cut where items of a row start, gives the items one by one, with all tokens in order."""
    row = read(latex)
    starts = [*(item.start for item in row.items), row.end]
    pieces = [latex[start:stop] for start, stop in pairwise(starts)]
    assert [shape(read(piece)) for piece in pieces] == [[shape(item)] for item in row.items]
    assert [token.start for token in tokens(latex)] == sorted({token.start for token in tokens(latex)})


REFUSED = (
    ("{a", "'}'", 3), (r"\left( a", r"'\right'", 9), (r"\begin{matrix} a", r"'\end{matrix}'", 17), (r"\sqrt[3 x", "']'", 10),
    (r"\begin{matrix} a \end{pmatrix}", r"'\end{matrix}'", 18), (r"\frac{a}", "a group in braces", 9), ("x^", "a group in braces", 3),
    (r"\left( a^ \right)", "a group in braces", 11), ("x^2^3", "a repeated power", 4), ("x_1_2", "one subscript", 4), ("^2", "a symbol", 1),
    (r"a \right)", "before this", 3), (r"{a \end{matrix}}", "'}'", 4), (r"\left a", r"after \left", 1), (r"\bar{\begin}", r"after \begin", 6),

    ("{'}", "a symbol", 2), ("{" * 70 + "}" * 70, "60 nested levels", 61), (r"\dot" * 100 + "x", "60 nested levels", 241),
)  # fmt: skip


@pytest.mark.parametrize(("latex", "expected", "position"), REFUSED, ids=[latex[:30] for latex, _, _ in REFUSED])
def test_unreadable_text_is_refused_with_its_place(latex, expected, position):
    with pytest.raises(InputError) as refusal:
        read(latex, "page 3")
    message = str(refusal.value)
    assert message.startswith("page 3: expected ") and expected in message and f"position {position}," in message


def test_a_chain_is_divided_at_its_signs():
    sides = divided(read(r"a = \frac{b = c}{2} = d"), "=")
    assert [shape(side) for side in sides] == [["a"], [("frac", ["b", "=", "c"], ["2"])], ["d"]]
    assert [shape(side) for side in divided(read("= a ="), "=")] == [[], ["a"], []]
    assert alone(read("{{x}}")).text == "x" and shape(alone(read("{x y}"))) == ["x", "y"]


def test_the_cursor_gives_scripts_after_their_piece_and_brackets_one_by_one():
    cursor = Cursor(r"\left(a\,b\right)^2", "", read(r"\left(a\,b\right)^2"))
    assert [item.text for item in cursor.items] == ["(", "a", "b", ")", "^", ""]
    assert cursor.after_space == {9}
    assert cursor.take("(") and not cursor.take("(") and cursor.script("^") is None
    with pytest.raises(InputError, match="expected '=' at position 7,"):
        cursor.expect("=")
    cursor.index = 4
    power = cursor.script("^")
    assert isinstance(power, Script) and cursor.inside(power.inside, lambda: cursor.next().text) == "2"
    with pytest.raises(InputError, match="expected '}'"):
        cursor.inside(read("a b"), cursor.next)
