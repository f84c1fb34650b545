"""Matrices in LaTeX, and bars, whose meaning depends on what is between them."""

from symrot.checker.claim.tree import Node
from symrot.checker.latex.calculus import CalculusPart
from symrot.latex import tree

__all__ = ["MatricesPart"]

MATRICES = {"matrix": "", "pmatrix": "", "bmatrix": "", "Bmatrix": "", "smallmatrix": "", "array": "", "vmatrix": "det"}
SEVERAL_LINES = ("align", "aligned", "alignat", "gather", "gathered", "eqnarray", "split", "multline", "cases",
                 "flalign")  # fmt: skip


class MatricesPart(CalculusPart):
    """The part of the checker's interpreter for matrices, and for bars around them."""

    def bars(self, bar: tree.Node) -> Node:
        inner = self.barred(self.expression, bar.text)
        if bar.text == "\\|" or self.names.is_column(inner):
            return Node("call", "sqrt", (Node("call", "dot", (inner, inner)),))
        return Node("call", "det" if self.names.is_matrix(inner) else "abs", (inner,))

    def environment(self, table: tree.Table) -> Node:
        name = table.name
        if name.rstrip("*") in SEVERAL_LINES:
            raise self.fail(f"one equation instead of the lines of {name}", table)
        if name not in MATRICES:
            raise self.fail(f"one of the environments {', '.join(MATRICES)}", table)
        between = "& or \\\\ between the entries of a matrix"
        rows = [[self.inside(cell, self.expression, between) for cell in line] for line in table.lines]
        if len({len(row) for row in rows}) > 1:
            raise self.fail("rows of equal length in a matrix", table)
        made = Node("call", "Matrix", (_listed([_listed(row) for row in rows]),))
        return Node("call", MATRICES[name], (made,)) if MATRICES[name] else made


def _listed(members: list[Node]) -> Node:
    return Node("list", ("[", "]"), tuple(members))
