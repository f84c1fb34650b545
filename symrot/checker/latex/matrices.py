"""Matrices in LaTeX, and the test whether a tree is a matrix or a column, on which products and bars depend."""

from symrot.checker.claim.tree import Node
from symrot.checker.latex.calculus import CalculusPart
from symrot.checker.latex.tokens import Token

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
    """The part of the reader for matrices, and for bars around them."""

    def bars(self, token: Token) -> Node:
        outside = self.open_bars
        self.open_bars = (*outside, token.text)
        inner = self.expression()
        self.open_bars = outside
        self.expect(token.text)
        if token.text == "\\|" or self.is_column(inner):
            return Node("call", "sqrt", (Node("call", "dot", (inner, inner)),))
        return Node("call", "det" if self.is_matrix(inner) else "abs", (inner,))

    def environment(self, token: Token) -> Node:
        name = self.environment_name()
        if name.rstrip("*") in SEVERAL_LINES:
            raise self.fail(f"one equation instead of the lines of {name}", token)
        if name not in MATRICES:
            raise self.fail(f"one of the environments {', '.join(MATRICES)}", token)
        if name == "array":
            self.expect("{")
            while self.at("c", "l", "r", "|"):
                self.next()
            self.expect("}")
        bars, self.open_bars = self.open_bars, ()
        rows = [[self.expression()]]
        while not self.at("\\end"):
            if self.take("&"):
                rows[-1].append(self.expression())
            elif self.take("\\\\"):
                if not self.at("\\end"):
                    rows.append([self.expression()])
            else:
                raise self.fail("& or \\\\ between the entries of a matrix")
        self.next()
        self.open_bars = bars
        if self.environment_name() != name:
            raise self.fail(f"\\end{{{name}}}", token)
        if len({len(row) for row in rows}) > 1:
            raise self.fail("rows of equal length in a matrix", token)
        made = Node("call", "Matrix", (_listed([_listed(row) for row in rows]),))
        return Node("call", MATRICES[name], (made,)) if MATRICES[name] else made

    def environment_name(self) -> str:
        self.expect("{")
        name = ""
        while self.peek().kind == "letter" or self.at("*"):
            name += self.next().text
        self.expect("}")
        return name

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
