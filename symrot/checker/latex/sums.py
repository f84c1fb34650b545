"""Parsing sums, products, powers, brackets and matrices in LaTeX, by the order of operations."""

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any, ClassVar

from symrot.checker.arrays.index_notation import component_of_cross
from symrot.checker.arrays.pauli import commutator
from symrot.checker.arrays.quaternions import CONJUGATE, quaternion_product
from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.tree import Node, is_derivative, matrix_of_rows, negated, number, product, quotient, sum_of
from symrot.checker.claim.vectors import MARK, length
from symrot.checker.latex.cursor import CLOSING, UPRIGHT, Cursor, is_d, is_letter
from symrot.checker.latex.macros import INSTEAD
from symrot.checker.typed.cursor import DEEPEST_NESTING, SHARED, is_usual_vector
from symrot.checker.typed.defined_functions import DEFINED
from symrot.checker.typed.words import ALIASES
from symrot.latex import tree

__all__ = ["FUNCTIONS", "SEVERAL_LINES", "SIGNS", "SumsPart"]

FUNCTIONS = {
    f"\\{command}": ALIASES.get(command, command)
    for command in (
        "sin", "cos", "tan", "cot", "sec", "csc", "sinh", "cosh", "tanh", "exp", "ln", "tg", "ctg", "cosec", *DEFINED,
        *(alias for alias, name in ALIASES.items() if name in DEFINED or name in ("asin", "acos", "atan")),
    )
}  # fmt: skip
"""LaTeX command -> function: tan for ``\\tg``. ``\\log``, whose base differs from book to book, is refused."""

LONGEST_MATRIX_NAME = 2
"""The largest number of letters in the name of a matrix in brackets: ``[C]`` and ``[FB]``."""

MATRICES = {"matrix": "", "pmatrix": "", "bmatrix": "", "Bmatrix": "", "smallmatrix": "", "array": "", "vmatrix": "det"}
SEVERAL_LINES = ("align", "aligned", "alignat", "gather", "gathered", "eqnarray", "split", "cases", "dcases", "flalign",
                 "multline")  # fmt: skip
SIGNS = {
    "=": "==", "\\ge": ">=", "\\geq": ">=", "\\geqslant": ">=", ">": ">", "\\gt": ">", "\\le": "<=", "\\leq": "<=",
    "\\leqslant": "<=", "<": "<", "\\lt": "<",
}  # fmt: skip
"""Relation sign in LaTeX -> the sign in SymPy syntax: ``>=`` for ``\\geq``, ``==`` for ``=``."""

QUATERNION_SIGNS = ("\\otimes", "\\circ", "\\odot")
"""LaTeX commands for operators that mean the product of quaternions, as in ``p \\otimes q``."""

QUATERNION_LETTERS = ("q", "p", "Q", "P")
"""Letters that usually denote quaternions."""

ENDS = frozenset([
    "", "+", "-", ")", "]", "\\}", "}", "&", "\\\\", ",", ";", "\\end", "\\cdot", "\\times", "*", "/", "^", "_", "'",
    *QUATERNION_SIGNS, *SIGNS,
])  # fmt: skip
"""Texts of the LaTeX nodes that cannot start a factor; the node at the end of a formula has the text ""."""

NORM = re.compile(r"\\(?:\||lVert|Vert)(.*?)\\(?:\||rVert|Vert)")
"""Pattern of a norm, such as ``\\|a + b\\|``: the names in it are vectors, or quaternions."""

QUATERNIONS = ("q", "p")

TRIPLE_PRODUCT = re.compile(
    r"\\times\s*(?:\\left)?\([^()+-]*\\times|\([^()]*\\times[^()]*\)\s*\\times|\)\s*\\times\s*(?:\\left)?\("
)
r"""Pattern of a product ``a\times(b\times c)``, ``(a\times b)\times c`` or ``(a + b)\times(a - b)``."""


class SumsPart(Cursor):
    """The methods of the LaTeX reader that parse sums, products, powers, brackets and matrices."""

    vector: Callable[[str], Node]
    """Method of a subclass that returns the node of a vector with the given name."""

    named: Callable[[str, Any], Node]
    """Method of a subclass that parses the subscript, primes and ``(t)`` after a name."""

    leibniz: Callable[[], Node | None]
    """Method of a subclass that parses a derivative with a slash, ``dx/dt``, and returns None if there is none."""

    readers: ClassVar[Mapping[str, Callable[[Any, Any], Node]]] = {}
    """Kind or text of a LaTeX node -> the method, perhaps of a subclass, that parses a factor that starts with it."""

    def expression(self) -> Node:
        """Parse a sum and return its tree."""
        self.depth += 1
        if self.depth > DEEPEST_NESTING // 2:
            raise self.fail(f"at most {DEEPEST_NESTING // 2} nested levels of brackets and arguments")
        terms = [self.term(sign=True)]
        while self.at("+", "-"):
            negative = self.next().text == "-"
            term = self.term(sign=False)
            terms.append(negated(term) if negative else term)
        self.depth -= 1
        return sum_of(terms)

    def term(self, sign: bool) -> Node:
        negative = False
        if sign and self.at("+", "-"):
            negative = self.next().text == "-"
        left = self.run()
        crossed = False
        while self.at("\\cdot", "\\times", "*", *QUATERNION_SIGNS) and not self.is_cross_matrix():
            operator = self.next()
            right = self.run()
            if operator.text in QUATERNION_SIGNS:
                left = quaternion_product(left, right)
                continue
            kinds = self.names.is_matrix(left), self.names.is_matrix(right)
            if operator.text == "\\times" and any(kinds) and not all(kinds):
                self.note_vector(right if kinds[0] else left)
            elif operator.text == "\\cdot" and any(kinds) and not all(kinds):
                other = last_factor(right if kinds[0] else left)
                name = name_of(other)
                if (is_usual_vector(name) or name == "g") and name not in {*SHARED, *self.vectors}:
                    self.note_vector(other)
            elif not any(kinds) and self.has_bare_vectors(left, right, operator.text):
                for side in (left, right):
                    self.note_vector(last_factor(side))
            if operator.text == "*" or not any(kinds) or (operator.text == "\\cdot" and not all(kinds)):
                left = product([left, right])
            elif not all(kinds):
                raise self.fail("a vector on both sides of \\times, or on neither side", operator)
            elif crossed and not (operator.text == "\\cdot" and self.is_row(left)):
                raise self.fail("brackets that say which product of vectors comes first", operator)
            elif operator.text == "\\cdot":
                left, crossed = self.scalar_product(left, right), True
            else:
                left, crossed = Node("call", "cross", (left, right)), True
        return negated(left) if negative else left

    def has_bare_vectors(self, left: Node, right: Node, sign: str) -> bool:
        r"""Return whether the text shows that unmarked letters at ``\times`` or ``\cdot`` are vectors, as in
        ``\omega\times r``.
        """
        names = [name_of(last_factor(side)) for side in (left, right)]
        inside = set(re.findall("[A-Za-z]+", " ".join(NORM.findall(self.source))))
        if self.flips is not None and sign == "\\cdot" and {*names} <= inside - {*QUATERNIONS}:
            return True
        if self.flips is None or sign not in ("\\times", "\\cdot") or not all(map(is_usual_vector, names)):
            return False
        function = {"\\times": "\\sin", "\\cdot": "\\cos"}[sign]
        lengths = [rf"\|\s*\\?{re.escape(name)}\s*\\?(r?Vert)?\|" for name in names]
        # the lengths of both beside the cosine or sine of an angle
        if function in self.source and all(re.search(length, self.source) for length in lengths):
            return True
        letters = [re.split("[_0-9]", name)[0] for name in names]
        # a x a = 0
        is_zero = names[0] == names[1] and re.search(r"=\s*0\b|\b0\s*=", self.source) is not None
        # a x b and b x a
        is_turned = names[0] != names[1] and all(
            re.search(rf"{re.escape(first)}\s*\\times\s*\\?{re.escape(second)}(?![A-Za-z])", self.source)
            for first, second in (names, names[::-1])
        )
        # r as the first letter, an angular velocity or acceleration, both signs, or a triple product; W = F x d may be
        # a product of numbers
        is_certain = letters[0] == "r" or bool({"omega", "Omega", "alpha"} & {*letters}) or is_turned
        is_certain = is_certain or "\\cdot" in self.source or TRIPLE_PRODUCT.search(self.source) is not None
        return sign == "\\times" and (is_certain or is_zero)

    def is_cross_matrix(self) -> bool:
        r"""Return whether a cross is directly before a closing bracket, as in the skew matrix ``[a \times]``."""
        return self.at("\\times") and self.peek(1).text == "]"

    def note_vector(self, node: Node) -> None:
        """Record that a name in a cross product, or the name whose rate is in it, is a vector.

        The text is then parsed again, with this name as a vector.
        """
        name = name_of(node)
        is_name = node.kind in ("name", "call") and name not in BUILT_IN and not str(name).endswith(MARK)
        if is_name and self.names.implied and str(name) not in self.names:
            self.crossed.add(str(name))

    def scalar_product(self, left: Node, right: Node) -> Node:
        """Return the product that a dot means between vectors or tensors.

        Two vectors give ``dot(a, b)``; a tensor I before a vector b gives ``I*b``, and after a vector a, ``a.T*I``.
        """
        if self.is_row(left):
            return Node("call", "dot", (Node("transpose", None, (left,)), right))
        if not (self.is_tensor(left) or self.is_tensor(right)):
            return Node("call", "dot", (left, right))
        return product([left if self.is_tensor(left) else Node("transpose", None, (left,)), right])

    def is_tensor(self, node: Node) -> bool:
        """Return whether a tree is the name of a tensor in bold, such as I for inertia."""
        # bold names that the claim does not list among its columns are tensors
        return node.kind == "name" and str(node.value).endswith(MARK) and not self.names.is_column(node)

    def is_row(self, node: Node) -> bool:
        """Return whether a tree is ``a.T*I``, the product of a transposed vector and a tensor."""
        factors = node.args if node.kind == "product" else ()
        return len(factors) > 1 and self.is_tensor(factors[-1]) and any(f.kind == "transpose" for f in factors)

    def run(self) -> Node:
        """Parse factors without product signs, perhaps with slashes, as ``a/b`` and ``1/2 m``; return their product."""
        factors = [self.factor()]
        divided: tree.Node | None = None
        while True:
            token = self.peek()
            if token.text == "/":
                self.next()
                if divided:
                    raise self.fail("brackets, since a second slash is ambiguous", token)
                if factors[-1].kind == "call" and factors[-1].value in FUNCTIONS.values() and self.flips is None:
                    raise self.fail("brackets, since the slash may belong to the argument", token)
                divisor, sure = self.divisor(factors, token)
                factors.append(Node("inv", None, (divisor,)))
                divided = None if sure else token
            elif not self.starts_factor():
                return product(factors)
            elif token.kind == "number" and self.peek(1).text != "^":  # 10^{a} 10^{b} is a product
                raise self.fail("brackets or a product sign before a number")
            else:
                factors.append(self.factor())

    def divisor(self, factors: list[Node], slash: tree.Node) -> tuple[Node, bool]:
        """Parse the divisor after a slash, such as ``2m`` in ``p^2/2m``; return (divisor, whether its end is certain).

        The end is certain only in a fraction of numbers: the divisor in ``1/2 m`` is 2.
        """
        first = self.peek()
        below = [self.factor()]
        if len(factors) == 1 and factors[0].kind == below[0].kind == "number":
            # in 1/2 m, m does not belong to the divisor
            return below[0], True
        whole = first.kind == "number" and factors[-1].kind != "number"
        while self.starts_factor() and self.peek().kind != "number":
            follower = self.peek()
            usual = whole and is_letter(follower)
            ambiguous = "brackets, since it is not clear how much the slash divides by"
            if self.doubtful("divisor", slash, self.peek(1).start, ambiguous) == usual:
                break
            below.append(self.factor())
        return product(below), False

    def starts_factor(self) -> bool:
        """Return whether a factor may start at the cursor."""
        item = self.peek()
        if item.text in ENDS or self.words(item):
            return False
        if item.text in ("|", "\\|"):
            return item.text not in self.open_bars
        return not (self.integrals and self.differential())

    def differential(self) -> bool:
        """Return whether a differential such as ``dx``, the end of an integrand, is at the cursor."""
        return is_d(self.peek()) and is_letter(self.peek(1))

    def factor(self) -> Node:
        """Parse one factor with its exponents and return its tree."""
        if self.flips is not None and (derivative := self.leibniz()) is not None:
            return derivative
        item = self.next()
        node = self.base(item)
        bracketed = item.text in CLOSING or item.text == "\\left"
        while raised := self.script("^"):
            if node.kind == "power" and not bracketed:
                raise self.fail("brackets around a repeated power", raised)
            is_function = node.kind == "call" and node.value in FUNCTIONS.values()
            if is_function and item.start not in self.short and self.flips is None:
                raise self.fail(f"the power directly after the function, {item.text}^n(..)", raised)
            node = self.raised(node, raised.inside)
            bracketed = False
        return node

    def raised(self, node: Node, inside: tree.Node) -> Node:
        r"""Return ``node`` with the superscript ``inside``: a power, a transpose ``^T``, a conjugate ``^*``, degrees
        ``^\circ``, or a skew matrix ``^\times``.
        """
        mark = tree.alone(inside)
        if isinstance(mark, tree.Font) and mark.text in UPRIGHT:
            mark = tree.alone(mark.inside)
        if mark.text in ("T", "\\top", "\\intercal"):
            return Node("transpose", None, (node,))
        if mark.text in ("*", "\\ast", "\\star"):
            return self.starred(node)
        if mark.text == "\\circ":
            return quotient(product([node, Node("name", "pi")]), number(180))  # degrees
        if mark.text in ("\\times", "×"):
            self.note_vector(node)
            return Node("call", "skew", (node,))
        texts = [item.text for item in getattr(inside, "items", ())]
        if texts[:3:2] == ["(", ")"] or (isinstance(mark, tree.Delimited) and len(mark.inside.items) == 1):
            raise self.fail("a power like x^2 instead of x^{(2)}", inside)
        exponent = self.argument(inside)
        if exponent == number(2) and self.names.is_column(node):
            return Node("call", "dot", (node, node))
        return Node("power", None, (node, exponent))

    def starred(self, node: Node) -> Node:
        r"""Return the tree of a quantity with a star: the conjugate of a quaternion, or a name such as ``T^*``."""
        products = any(sign in self.source for sign in QUATERNION_SIGNS)
        if node.kind != "name" or products or str(node.value)[:1] in QUATERNION_LETTERS:
            return Node("call", CONJUGATE, (node,))
        base, marked, _ = str(node.value).partition(MARK)
        return self.vector(f"{base}_star") if marked else replace(node, value=f"{base}_star")

    def argument(self, node: tree.Node) -> Node:
        """Return the tree of a command's argument or of an exponent: a group in braces, or one letter or digit."""
        if isinstance(node, tree.Row):
            return self.inside(node, self.expression)
        if node.kind == "number":
            if self.is_cut(node):
                raise self.fail("braces around a number of several digits", node)
            return number(Fraction(node.text))
        if is_letter(node) or node.text == "\\pi":
            return self.inside(node, lambda: self.base(self.next()))
        raise self.fail("a letter, a digit, or a formula in braces", node)

    def is_cut(self, digit: tree.Node) -> bool:
        """Return whether a digit without braces belongs to a longer number: LaTeX reads ``x^12`` as ``x^1 2``."""
        return len(digit.text) > 1 or self.source[digit.start + 1 : digit.start + 2].isdigit()

    def base(self, item: tree.Node) -> Node:
        """Parse the factor that starts with ``item``, without exponents after it, and return its tree."""
        if item.kind == "number":
            return number(Fraction(item.text))
        if item.text == "\\pi":
            return Node("name", "pi")
        read = self.readers.get("letter" if is_letter(item) else item.text)
        if read is None:
            known = "a command that is known" if item.text.startswith("\\") else "a number, a symbol or a bracket"
            raise self.fail(f"{INSTEAD[item.text]}, instead of {item.text}" if item.text in INSTEAD else known, item)
        return read(self, item)

    def matrix_name(self) -> Node | None:
        r"""Parse capital letters in square brackets, ``[FB]``, as one matrix name; return None for other brackets."""
        texts = [item.text for item in self.items[self.index :]]
        end = texts.index("]") if "]" in texts else 0
        name, after = "".join(texts[:end]), self.peek(end + 1)
        is_name = name.isalpha() and name.isupper() and all(len(text) == 1 for text in texts[:end])
        if not is_name or not 1 <= end <= LONGEST_MATRIX_NAME or self.flips is None:
            return None
        if end == 1 and (isinstance(after, tree.Script) and tree.alone(after.inside).text in ("\\times", "×")):
            return None
        item = self.peek()
        self.index += end + 1
        if end > 1:
            self.notes.append(f"[{name}] is read as the name of one matrix, not as a product")
        return self.named(name, item)

    def bracket(self, opening: tree.Node) -> Node:
        if isinstance(opening, tree.Row) and not opening.items and (frame := self.script("^") or self.script("_")):
            return self.framed(frame)
        if opening.kind == "row":
            return self.inside(opening, lambda: self.paired(self.expression(), "+"))
        if opening.text == "[" and (matrix := self.matrix_name()) is not None:
            return matrix
        bars, self.open_bars = self.open_bars, ()
        inner = self.expression()
        if opening.text == "(" and "\\otimes" in self.source and self.take(","):  # a quaternion (0, v)
            inner = Node("list", ("(", ")"), (inner, self.expression()))
        inner = self.paired(inner, "-" if opening.text == "[" else "+") if opening.text in ("[", "\\{") else inner
        crossed = opening.text == "[" and self.take("\\times")
        self.expect(CLOSING[opening.text])
        self.open_bars = bars
        mark = self.peek()
        if not crossed:
            is_cross = isinstance(mark, tree.Script) and tree.alone(mark.inside).text in ("\\times", "×")
            if isinstance(mark, tree.Script) and mark.text == "_" and inner.value == "cross":
                index, used = tree.alone(mark.inside).text, "".join(re.findall(r"_\{?(\w+)", self.source))
                if (component := component_of_cross(inner.args, index, used)) is not None:
                    self.next()
                    return component
            if opening.text != "[" or not is_cross:
                return inner
            self.next()
        self.note_vector(inner)
        return Node("call", "skew", (inner,))

    def paired(self, first: Node, sign: str) -> Node:
        """Parse ``, B`` after ``first``, the A of a bracket ``[A, B]`` or ``{A, B}`` of Pauli's matrices.

        Return A B - B A for the ``sign`` "-", A B + B A for "+", and A if no comma follows. Raise InputError if A or B
        has no Pauli matrix.
        """
        if not self.at(","):
            return first
        comma = self.next()
        pair = commutator(first, self.expression(), sign)
        if pair is None:
            raise self.fail(
                "a closing bracket (write a commutator as A B - B A, unless A and B contain Pauli matrices)", comma
            )
        return pair

    def framed(self, mark: tree.Script) -> Node:
        """Parse a name after the ``mark`` of its frame, as in ``{}^A R_B``, and return the node of the name."""
        frame = tree.alone(mark.inside)
        while isinstance(frame, tree.Font):
            frame = tree.alone(frame.inside)
        letter = frame.text.removeprefix("\\")
        name = self.base(self.next())
        # the only frame of the text is left out; with several, it becomes part of the name, R_B_A
        if len(self.frames) == 1:
            self.notes.append(f"the letter {letter} before a name is read as its frame and ignored")
            return name
        if name.kind not in ("name", "call") or not letter.isalnum():
            raise self.fail("a letter or number as the frame of a name, such as A in {}^A v", mark)
        base, marked, _ = str(name.value).partition(MARK)
        self.notes.append(f"the frame {letter} before {base} is read as a part of the name, {base}_{letter}")
        return self.vector(f"{base}_{letter}") if marked else replace(name, value=f"{base}_{letter}")

    def bars(self, bar: tree.Node) -> Node:
        inner = self.barred(self.expression, bar.text)
        if bar.text == "\\|" or self.names.is_column(inner):
            return length(inner)
        return Node("call", "det" if self.names.is_matrix(inner) else "abs", (inner,))

    def environment(self, table: tree.Table) -> Node:
        name = table.name
        if name.rstrip("*") in SEVERAL_LINES:
            raise self.fail(f"one equation instead of the environment {name} with several lines", table)
        if name not in MATRICES:
            raise self.fail(f"one of the environments {', '.join(MATRICES)}", table)
        between = "& or \\\\ between the entries of a matrix"
        rows = [[self.inside(cell, self.expression, between) for cell in line] for line in table.lines]
        if len({len(row) for row in rows}) > 1:
            raise self.fail("rows of equal length in a matrix", table)
        made = matrix_of_rows(rows)
        return Node("call", MATRICES[name], (made,)) if MATRICES[name] else made


def last_factor(node: Node) -> Node:
    r"""Return the last factor of a product, omega for ``I\omega``; return any other tree unchanged."""
    return node.args[-1] if node.kind == "product" else node


def name_of(node: Node) -> str:
    """Return the name of a symbol, a function or a derivative's quantity: "x" for x, x(t) and dx/dt; else ""."""
    if is_derivative(node):
        node = node.args[0]
    return str(node.value) if node.kind in ("name", "call") else ""
