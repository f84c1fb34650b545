"""Parsing names in LaTeX: subscripts, primes, ``(t)``, marks of vectors, words in upright letters."""

import re
from collections.abc import Callable, Iterator
from dataclasses import replace

from symrot.checker.arrays.quaternions import CONJUGATE
from symrot.checker.claim.functions import BUILT_IN, ROTATIONS
from symrot.checker.claim.tree import TIME, Node, column_vector, differentiated, negated, number, sum_of
from symrot.checker.claim.vectors import MARK, direction, is_tensor
from symrot.checker.latex.cursor import CLOSING, UPRIGHT, is_letter
from symrot.checker.latex.sums import SumsPart
from symrot.latex import tree

__all__ = ["NAME_MARKS", "OPERATORS", "VECTOR_MARKS", "NamesPart"]

OPERATORS = {
    "\\max": "max", "\\min": "min",
    "\\arg": "arg", "\\det": "det", "\\tr": "trace", "\\diag": "diag", "\\Re": "real_part", "\\Im": "imaginary_part",
}  # fmt: skip
SPELLED = {
    "tr": "trace", "Tr": "trace", "Det": "det", "Diag": "diag", "Atan2": "atan2", "ATAN2": "atan2", "arctan2": "atan2",
    "arcsin": "asin", "arccos": "acos", "arctan": "atan", "ln": "log", "vers": "vers", "adj": "adjugate",
    "Re": "real_part", "Im": "imaginary_part", "arg": "arg",
    **{name: name for name in BUILT_IN},
}  # fmt: skip
"""Name in upright letters, as in ``\\mathrm{tr}`` -> the function that it means: trace for tr."""

PART = "1:3"
"""The subscript in ``q_{1:3}``, the vector part (q_1, q_2, q_3) of a quaternion."""

MARKS_IN_SUBSCRIPTS = {
    "+": "plus", "-": "minus", "*": "star", "\\ast": "star", "\\perp": "perp", "\\parallel": "par", "\\|": "par",
    "\\max": "max", "\\min": "min", "\\infty": "inf", ",": "_", "/": "_", ":": ":", "\\rm": "", "\\circ": "circ",
}  # fmt: skip
"""Sign or command in a subscript -> the text for it in a name: "plus" for +."""

AXES = re.compile("[xyz]{1,2}|[123]{1,2}")
POINT = re.compile("[A-SU-Z]|cm|com|cg|CM|COM|CG")
"""Pattern of the raised name of a point or body in ``I_{xy}^G``: a moment of inertia has no such power.

T is no point: it transposes."""

TOTALS = ("M", "F", "N", "T", "tau", "Gamma")
"""Letters of torques and forces: ``\\sum M`` without limits is read as one quantity, their total."""

BOLD = ("\\mathbf", "\\bm", "\\boldsymbol")
VECTOR_MARKS = ("\\vec", *BOLD, "\\hat", "\\overrightarrow", "\\underline")
NAME_MARKS = {"\\bar": "_bar", "\\tilde": "_tilde", "\\overline": "_bar", "\\widetilde": "_tilde", "\\mathcal": "_cal"}


class NamesPart(SumsPart):
    """The methods of the LaTeX reader that parse names, and functions that are called by name."""

    def letter(self, item: tree.Node) -> Node:
        """Parse what follows a letter; return the node of the name, or of a cosine or sine in short form."""
        if item.start in self.short:
            return self.cosine_or_sine(item)
        return self.named(item.text.removeprefix("\\"), item)

    def cosine_or_sine(self, item: tree.Node) -> Node:
        r"""Parse what follows the letter of a short form such as ``c_\theta``; return the cosine, sine or versine."""
        function, angles = self.short[item.start]
        power = None if angles else self.script("^")
        if angles:
            self.script("_")
            terms = tuple(Node("name", self.resolved(*angle.partition("_")[::2])) for angle in angles)
        else:
            terms = (self.letter(self.next()),)
        if item.start == min(self.short):
            letters = (
                self.source[item.start : self.peek().start].strip() if angles else f"{item.text}\\{terms[0].value}"
            )
            meaning = " + ".join(str(term.value) for term in terms)
            words = f"1 - cos({meaning})" if function == "vers" else f"{function}({meaning})"
            self.notes.append(f"{letters} is read as {words}, and similar short forms likewise")
        angle = terms[0] if len(terms) == 1 else Node("sum", None, terms)
        value = Node("call", function, (angle,))
        if function == "vers":
            value = sum_of([number(1), negated(Node("call", "cos", (angle,)))])
        return value if power is None else self.raised(value, power.inside)

    def named(self, name: str, item: tree.Node) -> Node:
        """Parse the subscript, primes and ``(t)`` after a name; return the tree of the whole name."""
        if name == "Sigma" and self.peek().text.removeprefix("\\") in TOTALS and self.flips is not None:
            return self.total(item)
        if name in ("Delta", "delta") and name not in self.names and not self.at("_", "'"):
            follower = self.peek()
            if is_letter(follower):
                return self.change(name, item)
        primes, subscript = 0, ""
        while mark := self.script("_") or self.script("'"):
            if mark.text == "'":
                primes = len(mark.inside.text)
            else:
                subscript = self.subscript(mark)
        if name in ("I", "J") and AXES.fullmatch(subscript) and (point := self.raised_point()):
            subscript = f"{subscript}_{point}"
        if subscript == PART:
            return column_vector([Node("name", self.resolved(name, digit)) for digit in "123"])
        known = self.resolved(name, subscript)
        if known.partition("_prime")[0] in ROTATIONS and self.at("(") and known not in self.names:
            known = known.partition("_prime")[0]  # R_{y'} rotates about an axis that the rotations before it have moved
        if known in ROTATIONS and known not in self.names and self.at("("):
            return self.called(known)
        if name == "S" and not subscript and (skew := self.skew_of_vector()) is not None:
            return skew
        if primes and (known in self.names.functions or self.called_with_time()):
            self.take_time_call(known)
            return self.derivative(Node("name", known), primes, item)
        if primes:
            known = self.resolved(known + "_prime" * primes, "", (known + "p" * primes,))
        self.take_time_call(known)
        return self.vector(known) if known in self.crossed else Node("name", known)

    def raised_point(self) -> str:
        r"""Parse and return the raised name of a point, G in ``I_{xy}^G``; return "" and stay before anything else."""
        mark = self.peek()
        if not self.names.implied or not isinstance(mark, tree.Script) or mark.text != "^":
            return ""
        point = _letters(mark.inside).strip("()")
        if not POINT.fullmatch(point):
            return ""
        self.next()
        return point

    def skew_of_vector(self) -> Node | None:
        r"""Parse the bracket of ``S(\omega)`` and return the skew matrix of the vector; None for any other bracket."""
        inner = self.peek(1)
        is_vector = inner.text in ("\\omega", "\\Omega", *VECTOR_MARKS) and self.peek(2).text == ")"
        if not self.at("(") or not is_vector or "S" in self.names or self.flips is None:
            return None
        self.next()
        vector = self.base(self.next())
        self.expect(")")
        self.note_vector(vector)
        self.notes.append("S(..) is read as the skew matrix of a vector")
        return Node("call", "skew", (vector,))

    def change(self, name: str, item: tree.Node) -> Node:
        r"""Parse a change of a quantity, such as ``\Delta t``; return the node of the single name Delta_t, or of Delta
        if a product is meant.
        """
        follower = self.peek()
        product_or_change = f"\\{name}_{{..}} for a change, or \\cdot for a product"
        if self.flips is None:
            raise self.fail(product_or_change, follower)
        if self.doubtful("change", item, self.end_of_next(), product_or_change):
            # Delta times t: t is parsed as the next factor
            return Node("name", name)
        quantity = self.letter(self.next())
        if quantity.kind != "name":
            raise self.fail(f"a name after \\{name}", follower)
        return Node("name", f"{name}_{quantity.value}")

    def end_of_next(self) -> int:
        """Return the position in the text at which the letter, command or bracket at the cursor ends."""
        return max(self.peek(1).start, self.peek().start + 1)

    def refuse_call(self) -> None:
        """Raise InputError for ``f(x)`` or ``f(0)``, which may be a product or the value of a function."""
        inner = self.peek(1)
        if self.at("(") and (inner.kind == "number" or is_letter(inner)) and self.peek(2).text == ")":
            raise self.fail("\\cdot before the bracket if this is a product, or a declared function if it is a call")

    def subscript(self, mark: tree.Script) -> str:
        """Return the content of a subscript as text: "1x" for ``_{1x}``."""
        inside = mark.inside
        if inside.kind == "number" and self.is_cut(inside):
            raise self.fail("braces around a subscript of several digits", inside)
        group = isinstance(inside, tree.Row | tree.Font) or inside.text in MARKS_IN_SUBSCRIPTS
        pieces = "".join(self.pieces((inside,))) if group or inside.kind == "number" or is_letter(inside) else ""
        if not pieces:
            raise self.fail("a subscript of letters and digits", inside)
        return pieces

    def pieces(self, items: tuple[tree.Node, ...]) -> Iterator[str]:
        """Yield the parts of a name's subscript as text: "a" and "plus" for ``a+``, with "_" for a comma.

        A prime becomes "_prime". Fonts and the marks of vectors are left out. ``items`` are the nodes of the subscript.
        """
        for item in items:
            if isinstance(item, tree.Row):
                yield from self.pieces(item.items)
            elif isinstance(item, tree.Font) and item.text in (*UPRIGHT, "\\text"):
                yield from self.pieces((item.inside,))
            elif item.text in MARKS_IN_SUBSCRIPTS:
                yield MARKS_IN_SUBSCRIPTS[item.text]
            elif isinstance(item, tree.Scripts) and {script.text for script in item.scripts} == {"'"}:
                yield from self.pieces((item.base,))
                yield "_prime" * len(item.scripts[0].inside.text)
            elif isinstance(item, tree.Scripts) and {script.text for script in item.scripts} == {"_"}:
                yield from self.pieces((item.base, item.scripts[0].inside))
            elif isinstance(item, tree.Accent | tree.Font) and item.text in VECTOR_MARKS:
                yield from self.pieces((item.inside,))
            elif (item.kind == "number" or is_letter(item)) and "." not in item.text:
                yield item.text.removeprefix("\\")
            elif item.kind != "space":
                place = item.scripts[0] if isinstance(item, tree.Scripts) else item
                raise self.fail("letters and digits in a subscript", place)

    def resolved(self, name: str, subscript: str, others: tuple[str, ...] = ()) -> str:
        """Return a name with its subscript as the claim declares it: ``I_1``, ``I1`` or one of ``others``.

        Return ``I_1`` if the claim declares none of these.
        """
        forms = [f"{name}_{subscript}", f"{name}{subscript}"] if subscript else [name]
        return next((form for form in [*forms, *others] if form in self.names), forms[0])

    def called_with_time(self) -> bool:
        return self.at("(") and self.peek(1).text == "t" and self.peek(2).text == ")"

    def derivative(self, node: Node, times: int, item: tree.Node) -> Node:
        """Return the time derivative of the formula ``node``, of the order ``times``.

        If the claim declares a symbol for the rate of x, such as dx, return this symbol for the first derivative of x.
        A name becomes a function of time unless the claim declares it as a function or matrix or defines it. If the
        claim must declare all its names, raise InputError for such a name instead; the message quotes the text at
        ``item``.
        """
        if node.kind == "name" and node.value not in (*self.names.functions, *self.names.matrices, *self.names.others):
            name = str(node.value)
            forms = ["d" * times + name, name + "dot", name + "d" * times]
            declared = [form for form in forms if form in self.names.symbols] if times == 1 else []
            if declared:
                return Node("name", declared[0])
            if not self.names.implied:
                raise self.fail(f"{name} to be declared as a function of t (it is differentiated)", item)
            self.timed.add(name)
        return differentiated(node, TIME, times)

    def take_time_call(self, name: str) -> None:
        """Skip ``(t)`` after a ``name`` that may be a function of time, and record that this name is one.

        Raise InputError for ``(x)`` or ``(0)`` after the name. The brackets of ``Omega(omega)``, the matrix in
        ``q' = Ω(ω) q/2``, are accepted and not skipped.
        """
        if self.called_with_time() and (
            name in self.names.functions or (self.names.implied and name not in self.names)
        ):
            self.index += 3
            self.timed.add(name)
        is_of_rates = name == "Omega" and self.at("(") and self.peek(1).text == "\\omega"
        if not is_of_rates:
            self.refuse_call()

    def marked(self, mark: tree.Accent | tree.Font) -> Node:
        r"""Parse a name with a mark, such as ``\vec{r}``, ``\mathbf R`` or ``\hat n``; return the node of a vector."""
        inside = tree.alone(mark.inside)
        if inside.kind == "number" and mark.text in BOLD:
            raise self.fail(
                "a name that is defined as a unit matrix, such as E = eye(3), instead of a bold number", inside
            )
        node = self.under(mark, self.symbol)
        if node.kind == "call" and node.value == "Matrix":
            return node
        inner = inside.text if inside.text in VECTOR_MARKS else ""  # \\hat{\\mathbf n}
        if node.kind == "product":  # \\mathbf{\\hat n}, beside n without a hat
            return node
        name = str(node.value)
        if name not in self.names.matrices:
            if not self.names.implied or name in self.names:
                raise self.fail(f"{name} to be declared as a vector or matrix ({mark.text} marks it as one)", mark)
            node = self.vector(name)
        bare = str(node.value).removesuffix(MARK)
        has_hat = mark.text == "\\hat" and bare in self.vectors
        if has_hat:
            self.hatted.add(bare)
            self.bare[bare] -= bool(inner)  # the inner mark has counted it
        elif inner != "\\hat":
            self.bare[bare] += 1
        self.refuse_call()
        if has_hat and bare in self.mixed:
            return direction(node)
        if has_hat:
            self.vectors[bare] = True
        return node

    def total(self, sign: tree.Node) -> Node:
        r"""Parse the name after a sum sign, ``\sum M_x``, and return its node: M_x is the total of all torques."""
        follower = self.peek()
        if follower.text.removeprefix("\\") not in TOTALS:
            raise self.fail("the terms of the sum, joined by +", sign)
        self.notes.append(f"\\sum {follower.text} is read as one quantity, the total")
        return self.factor()

    def vector(self, name: str) -> Node:
        """Record that ``name`` is a vector or tensor, so that its components get names; return its node."""
        name = name.removesuffix(MARK)
        self.vectors.setdefault(name, False)
        # an arrow at the end of the name distinguishes the vector r from its length r
        marked = name + MARK
        if marked not in self.names.matrices:
            columns = self.names.columns if is_tensor(name) else (*self.names.columns, marked)
            self.names = replace(self.names, matrices=(*self.names.matrices, marked), columns=columns)
        return Node("name", marked)

    def overlined(self, mark: tree.Accent | tree.Font) -> Node:
        r"""Parse a name with an accent: ``\bar I`` is a name of its own, not the symbol ``I``.

        A tilde over a vector gives the skew matrix of the vector, ``\overline`` over a formula its conjugate.
        """
        if tree.alone(mark.inside).text in VECTOR_MARKS and mark.text != "\\mathcal":
            inner = self.under(mark, self.expression)
            # a tilde over a vector means its skew matrix
            if "tilde" in mark.text:
                return Node("call", "skew", (inner,))
            return self.vector(str(inner.value).removesuffix(MARK) + NAME_MARKS[mark.text])
        if mark.text == "\\overline" and tree.alone(mark.inside).kind not in ("letter", "number", "command"):
            return Node("call", CONJUGATE, (self.under(mark, self.expression),))
        node = self.under(mark, lambda: self.symbol(NAME_MARKS[mark.text]))
        self.take_time_call(str(node.value))
        return node

    def under(self, mark: tree.Accent | tree.Font, read: Callable[[], Node]) -> Node:
        r"""Parse what is under a mark, and the subscript after the mark: H_G for ``\dot{\mathbf{H}}_G``."""
        scripts = []
        while script := self.script("_") or self.script("'"):
            scripts.append(script)
        inside = mark.inside
        items = inside.items if isinstance(inside, tree.Row) else (inside,)
        return self.inside(tree.Row((*items, *scripts), inside.start, self.peek().start), read)

    def symbol(self, ending: str = "") -> Node:
        """Parse a letter, a number, a command, or a symbol with a mark; return its tree.

        ``ending``, such as ``_bar``, is added to the name.
        """
        item = self.next()
        if item.text in VECTOR_MARKS and not ending:  # \\hat{\\mathbf n}
            return self.base(item)
        if item.kind not in ("letter", "number", "command"):
            raise self.fail("a letter", item)
        return self.named(item.text.removeprefix("\\") + ending, item)

    def spelled(self, font: tree.Font) -> Node:
        r"""Parse upright text and return its node: a call for a function's name, otherwise a name.

        ``\operatorname{tr}(R)`` gives ``trace(R)``, ``\mathrm{abc}`` the name abc.
        """
        node = self.under(font, lambda: self.word(font))
        if node.kind == "call":
            return self.called(str(node.value))
        self.take_time_call(str(node.value))
        return node

    def word(self, font: tree.Font) -> Node:
        """Parse letters and digits, with a subscript and primes; return a name, or the call of a built-in function."""
        name = ""
        while self.peek().kind in ("letter", "number"):
            name += self.next().text
        if not name and is_letter(self.peek()):
            name = self.next().text.removeprefix("\\")
        if not name.isalnum() or not name[0].isalpha():
            raise self.fail("a name of letters and digits")
        if name == "d" and self.peek().kind == "end":
            raise self.fail("an upright d only in a derivative d/dx or an integral with dx", font)
        return Node("call", SPELLED[name]) if name in SPELLED else self.named(name, font)

    def operator(self, item: tree.Node) -> Node:
        return self.called(OPERATORS[item.text])

    def called(self, name: str) -> Node:
        """Parse the arguments of the function ``name``: ``(x, y)`` in brackets, or one factor; return the call."""
        opening = self.peek()
        if opening.text not in CLOSING:
            return Node("call", name, (self.factor(),))
        self.next()
        return Node("call", name, tuple(self.listed(self.expression, CLOSING[opening.text])))


def _letters(node: tree.Node) -> str:
    """Return the letters, brackets and signs of a node of the LaTeX tree, without fonts."""
    if isinstance(node, tree.Row):
        return "".join(map(_letters, node.items))
    return _letters(node.inside) if isinstance(node, tree.Font) else node.text
