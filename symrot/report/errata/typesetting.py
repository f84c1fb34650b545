"""LaTeX of the formulas in the errata, as printed and as corrected, with boxes around the differences."""

import re
from collections import Counter
from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from typing import ClassVar

from symrot.checker.claim.tree import Node, number, product, sum_of
from symrot.checker.latex.writing import NO_VECTORS, PRODUCT, SUM, Writer
from symrot.latex.tokens import GREEK

__all__ = ["filled", "latex", "marked"]

HOLE = re.compile(r"@(\w+)@")
SUBSCRIPTED = re.compile(rf"([A-Za-z]|{'|'.join(GREEK)})_?(\d+|[a-z]{{1,2}})")
MARK = "mark"
"""The kind of a node that marks the subexpression inside it as changed."""


def marked(printed: Node, corrected: Node) -> tuple[Node, Node]:
    """Return two formulas with marks around the subexpressions in which they differ; LaTeX shows marks as boxes.

    Examples
    --------
    >>> from symrot.checker.claim.reader import read_expression
    >>> printed, corrected = marked(read_expression("a*x + b"), read_expression("a*x - b"))
    >>> latex(printed), latex(corrected)
    ('a x \\\\boxed{{}+ b}', 'a x \\\\boxed{{}- b}')
    """
    return _marked(_flat(printed), _flat(corrected))


def _flat(node: Node) -> Node:
    """Return a formula with nested sums and nested products joined, and without factors 1.

    ``a + (b + 1*c)`` -> ``a + b + c``.
    """
    args = tuple(map(_flat, node.args))
    if node.kind == "sum":
        return sum_of(list(args))
    if node.kind == "product":
        return product([arg for arg in args if arg != number(1)] or [number(1)])
    return replace(node, args=args)


def _marked(old: Node, new: Node) -> tuple[Node, Node]:
    if old == new:
        return old, new
    if new.kind in ("sum", "product") and old.kind != new.kind and old in new.args:
        return old, _marked_members(Node(new.kind, None, (old,)), new)[1]
    if old.kind in ("sum", "product") and old.kind != new.kind and new in old.args:
        return _marked_members(old, Node(old.kind, None, (new,)))[0], new
    if old.kind == new.kind and old.value == new.value:
        if old.kind in ("sum", "product"):
            return _marked_members(old, new)
        if len(old.args) == len(new.args) and old.args:
            pairs = [_marked(before, after) for before, after in zip(old.args, new.args, strict=True)]
            return replace(old, args=tuple(a for a, _ in pairs)), replace(new, args=tuple(b for _, b in pairs))
    return _mark(old), _mark(new)


def _mark(node: Node) -> Node:
    return Node(MARK, None, (node,))


def _marked_members(old: Node, new: Node) -> tuple[Node, Node]:
    """Return the printed and the corrected sum or product, with boxes around the terms or factors that differ.

    If each has the same number of these, they are compared in pairs, and only what differs inside a pair gets a box.
    """
    only_old, only_new = _places_of_others(old, new), _places_of_others(new, old)
    befores, afters = list(old.args), list(new.args)
    if len(only_old) == len(only_new):
        for before, after in zip(only_old, only_new, strict=True):
            befores[before], afters[after] = _marked(befores[before], afters[after])
        if len(only_old) == len(befores) == len(afters) > 1:
            return _mark(old), _mark(new)
    else:
        for place in only_old:
            befores[place] = _mark(befores[place])
        for place in only_new:
            afters[place] = _mark(afters[place])
    return replace(old, args=tuple(befores)), replace(new, args=tuple(afters))


def _places_of_others(node: Node, other: Node) -> list[int]:
    """Return the indices of the terms or factors of ``node`` that ``other``, a sum or product too, does not have."""
    remaining = Counter(other.args)
    places = []
    for place, member in enumerate(node.args):
        if remaining[member]:
            remaining[member] -= 1
        else:
            places.append(place)
    return places


def latex(node: Node, letters: Mapping[str, str] = {}, functions: Collection[str] = ()) -> str:
    """Return the LaTeX of a formula; the marked parts, which an erratum corrects, are in boxes.

    ``letters`` maps names to the LaTeX of the document's letters; ``functions`` are the names that depend on time.
    """
    return _Typesetter(letters, functions).formula(_flat(node) if node.kind != MARK else node)


def filled(template: str, parts: Mapping[str, Node], letters: Mapping[str, str], functions: Collection[str]) -> str:
    """Replace each hole ``@name@`` in a LaTeX template by the LaTeX of the formula ``parts[name]``.

    ``letters`` and ``functions`` are explained at :func:`latex`.
    """
    return HOLE.sub(lambda hole: latex(parts[hole[1]], letters, functions), template)


class _Typesetter(Writer):
    """Writer of LaTeX as a book prints it: with integrals, fractions, and the letters of the quoted document."""

    def __init__(self, letters: Mapping[str, str], functions: Collection[str]) -> None:
        super().__init__(functions, NO_VECTORS)
        self.letters = letters

    def formula(self, node: Node, binding: int = 0) -> str:
        if node.kind == MARK:
            return f"\\boxed{{{self.formula(node.args[0])}}}"
        written = super().formula(node, binding)
        is_tall = written.startswith("(") and any(name in written for name in ("\\frac", "matrix", "\\int"))
        if is_tall and written == f"({super().formula(node)})":
            return f"\\left{written[:-1]}\\right)"
        return written

    def name(self, node: Node) -> str:
        name = str(node.value)
        if name in self.letters:
            return self.letters[name]
        match = SUBSCRIPTED.fullmatch(name)
        if match and name not in GREEK and name != "pi":
            base = f"\\{match[1]}" if match[1] in GREEK else match[1]
            return f"{base}_{{{match[2]}}}" if len(match[2]) > 1 else f"{base}_{match[2]}"
        return super().name(node)

    def sum(self, node: Node) -> str:
        written = ""
        for place, term in enumerate(node.args):
            inner = term.args[0] if term.kind == MARK else term
            negative = inner.kind == "neg"
            sign = "-" if negative else "+" if place else ""
            body = self.formula(inner.args[0] if negative else inner, SUM + 1)
            if term.kind == MARK:
                written += f" \\boxed{{{{}}{sign} {body}}}" if sign else f"\\boxed{{{body}}}"
            else:
                written += f" {sign} {body}" if place else f"{sign}{body}"
        return written.strip()

    def product(self, node: Node) -> str:
        r"""Return a product as LaTeX; factors before a divisor become the numerator of a fraction.

        ``a/b*c`` -> ``\frac{a}{b} c``. A vector or matrix is put behind the fraction.
        """
        pieces: list[str] = []
        above: list[Node] = []
        for factor in node.args:
            inner = factor.args[0] if factor.kind == MARK else factor
            if inner.kind != "inv":
                above.append(factor)
                continue
            below = self.formula(inner.args[0])
            below = f"\\boxed{{{below}}}" if factor.kind == MARK else below
            scalars = [factor for factor in above if not self._is_array(factor)]
            pieces.append(f"\\frac{{{self._row(scalars) or '1'}}}{{{below}}}")
            above = [factor for factor in above if self._is_array(factor)]
        return " ".join([*pieces, *([self._row(above, alone=False)] if above else [])])

    def _is_array(self, factor: Node) -> bool:
        """Return whether a factor is a written-out matrix, or a letter that is printed bold or with an arrow."""
        inner = factor.args[0] if factor.kind == MARK else factor
        letter = self.letters.get(str(inner.value), "") if inner.kind == "name" else ""
        return (inner.kind == "call" and inner.value in ("Matrix", "diag")) or letter.startswith(("\\vec", "\\mathbf"))

    def _row(self, factors: list[Node], alone: bool = True) -> str:
        """Return the product of ``factors`` as LaTeX: ``[x, y + z]`` gives ``x (y + z)``.

        A single factor that is a sum has brackets only if ``alone`` is false: it then stands beside a fraction.
        """
        alone = alone and len(factors) == 1
        written = ""
        after_function = False
        for factor in factors:
            piece = self.formula(factor, 0 if alone else PRODUCT + 1)
            inner = piece.removeprefix("\\boxed{")
            sign = " \\cdot " if written and inner[0].isdigit() else " \\, " if after_function else " "
            written += sign + piece
            after_function = (
                inner.startswith("\\") and " " in inner and not inner.endswith(")") and factor.kind == "call"
            )
        return written.strip()

    def power(self, node: Node) -> str:
        base, exponent = node.args
        written = self.formula(base)
        whole = base.args[0] if base.kind == MARK else base
        if whole.kind == "name" or (whole.kind == "call" and whole.value in (*self.timed, "diff")):
            written = f"{{{written}}}" if "^" in written else written
            return f"{written}^{{{self.formula(exponent)}}}"
        return super().power(node)

    def argument(self, call: Node) -> str:
        """Return the LaTeX of a function's argument, without brackets if it is a single letter: sin x, sin(x + y)."""
        whole = call.args[0].args[0] if call.args[0].kind == MARK else call.args[0]
        if len(call.args) == 1 and (whole.kind == "name" or (whole.kind == "call" and whole.value in self.timed)):
            return f" {self.formula(call.args[0])}"
        return super().argument(call)

    def call(self, node: Node) -> str:
        name = str(node.value)
        if name == "integrate":
            integrand, *ranges = node.args
            signs = "".join(
                f"\\int_{{{self.formula(low)}}}^{{{self.formula(high)}}} " for _, low, high in (r.args for r in ranges)
            )
            ends = "".join(f" \\, d{self.formula(r.args[0])}" for r in ranges)
            return f"{signs}{self.formula(integrand, PRODUCT)}{ends}"
        if name == "diag" and all(entry.kind != "list" for entry in node.args):
            size = len(node.args)
            rows = [[self.formula(node.args[r]) if r == c else "0" for c in range(size)] for r in range(size)]
            lines = " \\\\ ".join(" & ".join(row) for row in rows)
            return f"\\begin{{bmatrix}} {lines} \\end{{bmatrix}}"
        if name == "diff" and len(node.args) > 1:
            return self._derivative(node)
        if name in self.timed and name in self.letters:
            return self.letters[name]
        return super().call(node)

    def _derivative(self, node: Node) -> str:
        inner, *variables = node.args
        timed = all(v.value == "t" for v in variables)
        if timed and (inner.kind == "name" or (inner.kind == "call" and inner.value in self.timed)):
            return f"\\{'d' * len(variables)}ot{{{self.formula(inner)}}}"
        order = "" if len(variables) == 1 else f"^{len(variables)}"
        by = self.formula(variables[0])
        return f"\\frac{{d{order}}}{{d{by}{order}}}({self.formula(inner)})"

    writers: ClassVar[Mapping[str, Callable[..., str]]] = {
        **Writer.writers, "name": name, "sum": sum, "product": product, "power": power, "call": call,
    }  # fmt: skip
