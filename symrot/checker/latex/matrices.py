"""Matrices in LaTeX, and the test whether a tree is a matrix or a column, on which products and bars depend."""

from symrot.checker.claim.tree import Node
from symrot.checker.latex.calculus import CalculusPart
from symrot.latex import tree

__all__ = ["MATRIX_CALLS", "MatricesPart"]

MATRICES = {"matrix": "", "pmatrix": "", "bmatrix": "", "Bmatrix": "", "smallmatrix": "", "array": "", "vmatrix": "det"}
SEVERAL_LINES = (
    "align",
    "aligned",
    "alignat",
    "gather",
    "gathered",
    "eqnarray",
    "split",
    "multline",
    "cases",
    "flalign",
)
MATRIX_CALLS = ("Matrix", "cross", "skew", "vee", "Rx", "Ry", "Rz", "inverse", "transpose", "eye", "diag", "qmul",
                "dcm_of", "hstack")  # fmt: skip


class MatricesPart(CalculusPart):
    """The part of the checker's interpreter for matrices, and for bars around them."""

    def bars(self, bar: tree.Node) -> Node:
        outside = self.open_bars
        self.open_bars = (*outside, bar.text)
        inner = self.expression()
        self.open_bars = outside
        self.expect(bar.text)
        if bar.text == "\\|" or self.is_column(inner):
            return Node("call", "sqrt", (Node("call", "dot", (inner, inner)),))
        return Node("call", "det" if self.is_matrix(inner) else "abs", (inner,))

    def environment(self, table: tree.Node) -> Node:
        assert isinstance(table, tree.Table)
        name = table.name
        if name.rstrip("*") in SEVERAL_LINES:
            raise self.fail(f"one equation instead of the lines of {name}", table)
        if name not in MATRICES:
            raise self.fail(f"one of the environments {', '.join(MATRICES)}", table)
        bars, self.open_bars = self.open_bars, ()
        between = "& or \\\\ between the entries of a matrix"
        rows = [[self.inside(cell, self.expression, between) for cell in line] for line in table.lines]
        self.open_bars = bars
        if len({len(row) for row in rows}) > 1:
            raise self.fail("rows of equal length in a matrix", table)
        made = Node("call", "Matrix", (_listed([_listed(row) for row in rows]),))
        return Node("call", MATRICES[name], (made,)) if MATRICES[name] else made

    def is_matrix(self, node: Node) -> bool:
        """Return whether a tree is a vector or a matrix."""
        if node.kind == "name":
            return node.value in self.names.matrices
        if node.kind == "call":
            return node.value in MATRIX_CALLS or (node.value == "diff" and self.is_matrix(node.args[0]))
        if node.kind == "index":
            return False
        kinds = [self.is_matrix(child) for child in node.args]
        if node.kind == "product" and len(kinds) > 1 and node.args[0].kind == "transpose":
            return True  # a row times a column is a 1 x 1 matrix
        return any(kinds)

    def is_column(self, node: Node) -> bool:
        """Return whether a matrix is a column: bars mean the length of a column, the determinant of other matrices."""
        if node.kind == "name":
            return node.value in self.names.columns
        if node.kind == "call" and node.value == "Matrix":
            return len(node.args[0].args[0].args) == 1
        if node.kind == "call":
            return node.value in ("cross", "vee") or (node.value == "diff" and self.is_column(node.args[0]))
        if node.kind == "product":
            return self.is_column(node.args[-1]) and node.args[0].kind != "transpose"
        return node.kind in ("sum", "neg") and self.is_column(node.args[0])


def _listed(members: list[Node]) -> Node:
    return Node("list", ("[", "]"), tuple(members))
