"""Writing claims in LaTeX, as a book would print them: a question in LaTeX gets its answer in LaTeX."""

import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import ClassVar

from symrot.checker.claim.functions import ROTATIONS
from symrot.checker.claim.notation import with_formulas
from symrot.checker.claim.reader import read_relation, with_time
from symrot.checker.claim.tree import TIME, Node, is_rate, nodes_of, number, text, untimed
from symrot.checker.latex.reader import Names, read_latex
from symrot.checker.typed.readings import Relation
from symrot.errors import InputError
from symrot.latex.tokens import GREEK

__all__ = ["LatexNotation", "Writer", "latex_of", "latex_of_text"]

COMMANDS = {
    **{name: f"\\{name}" for name in ("sin", "cos", "tan", "cot", "sec", "csc", "exp", "sinh", "cosh", "tanh", "det")},
    "asin": "\\arcsin", "acos": "\\arccos", "atan": "\\arctan", "log": "\\ln", "trace": "\\operatorname{tr}",
    "real_part": "\\Re", "imaginary_part": "\\Im",
}  # fmt: skip
"""Built-in function -> its LaTeX command: ``\\ln`` for log."""

DOTS = {1: "\\dot", 2: "\\ddot", 3: "\\dddot"}
VECTOR_SIGNS = {"cross": "\\times", "dot": "\\cdot", "qmul": "\\otimes"}
"""Product of two vectors or quaternions -> its sign in LaTeX."""

NO_VECTORS: Mapping[str, bool] = {}

SIGNS = {"==": "=", "!=": "\\neq", ">=": "\\geq", "<=": "\\leq", "and": "\\text{ and }", "or": "\\text{ or }"}
"""Sign of a condition -> its LaTeX."""

SUM, PRODUCT, SIGN, ATOM = 10, 20, 30, 50


@dataclass(frozen=True)
class LatexNotation:
    """Writes the formulas of a verdict as LaTeX, in the style of the user's LaTeX text.

    ``functions`` are the functions of time in that text, ``vectors`` maps the names of its vectors to whether they have
    a hat.
    """

    functions: Collection[str] = ()
    vectors: Mapping[str, bool] = field(default_factory=dict)

    def formula(self, node: Node) -> str:
        """Return the LaTeX of a formula, or its SymPy syntax if parsing the LaTeX would not give the same formula."""
        written = latex_of(("==", node, number(0)), self.functions, self.vectors)
        return text(node) if written is None else written.removesuffix(" = 0")

    def relation(self, relation: Relation) -> str:
        """Return the LaTeX of an equation or inequality, or SymPy syntax if the LaTeX would be read as another one."""
        sign, left, right = relation
        if sign != "==":
            return f"{self.formula(left)} {SIGNS.get(sign, sign)} {self.formula(right)}"
        return latex_of(relation, self.functions, self.vectors) or f"{text(left)} {sign} {text(right)}"

    def rewritten(self, source: str) -> str:
        """Return the LaTeX of an equation in SymPy syntax; ``source`` unchanged if no LaTeX has the same meaning."""
        return latex_of_text(source, self.functions, self.vectors)

    def condition(self, source: str) -> str:
        """Return the LaTeX of a condition in SymPy syntax."""
        return with_formulas(source, self.formula, SIGNS)


def latex_of(
    relation: Relation, functions: Collection[str] = (), vectors: Mapping[str, bool] = NO_VECTORS
) -> str | None:
    """Return the LaTeX of an equation; None if parsing it would not give the same equation, and for inequalities.

    Parameters
    ----------
    relation : Relation
    functions : collection of str
        The functions of time that are declared.
    vectors : mapping of str to bool
        The names of vectors, which are written in bold; those with the value True get a hat.

    Examples
    --------
    >>> latex_of(read_relation("diff(theta(t), t, t) == -g/l*sin(theta(t))"))
    '\\\\ddot{\\\\theta} = -\\\\frac{g}{l} \\\\sin(\\\\theta)'
    """
    if relation[0] != "==":
        return None
    nodes = nodes_of(*relation[1:])
    moving = {str(n.args[0].value) for n in nodes if n.value == "diff" and n.args[0].kind == "name"} - {*vectors}
    if moving:  # the rate of a quaternion is diff(q, t), since its components are the functions of time
        sign, left, right = relation
        relation = sign, with_time(left, moving), with_time(right, moving)
    rates = (node for node in nodes_of(*relation[1:]) if _is_dotted(node))
    timed = {str(rate.args[0].value) for rate in rates if rate.args[0].kind == "call"} | {*functions}
    try:
        written = " = ".join(Writer(timed, vectors).formula(side) for side in relation[1:])
        same = read_latex(written, names=Names(functions=functions)).text
    except (InputError, KeyError):
        return None
    return written if same == " == ".join(map(text, relation[1:])) else None


def latex_of_text(source: str, functions: Collection[str] = (), vectors: Mapping[str, bool] = NO_VECTORS) -> str:
    """Return the LaTeX of an equation in SymPy syntax; return the text itself if :func:`latex_of` returns None.

    Words after the equation (``with ..``) stay unchanged.
    """
    claim, joint, rest = source.partition(" with ")
    try:
        written = latex_of(read_relation(claim), functions, vectors)
    except InputError:
        written = None
    return source if written is None else written + joint + rest


def _is_dotted(node: Node) -> bool:
    """Return whether a tree is a time derivative of such a low order that dots over a letter can stand for it."""
    return is_rate(node) and len(node.args) - 1 in DOTS


def _is_square(node: Node) -> bool:
    """Return whether a formula is ``dot(a, a)``, the square of the length of a."""
    return node.kind == "call" and node.value == "dot" and node.args[0] == node.args[1]


@cache
def _with_marks(name: str) -> str:
    """Return the LaTeX of a name with a bar or prime; empty for other names, and if this LaTeX would be read as another
    name.

    Examples
    --------
    >>> _with_marks("I_bar_x_prime"), _with_marks("y_bar"), _with_marks("I_xy")
    ("\\\\bar{I}_{x'}", '\\\\bar{y}', '')
    """
    base, *rest = name.split("_")
    if not {"bar", "prime"} & {*rest}:
        return ""
    letters = [f"\\{word}" if word in GREEK else word for word in (base, *rest) if word not in ("bar", "prime")]
    primes = "'" * rest.count("prime")
    head = f"\\bar{{{letters[0]}}}" if "bar" in rest else letters[0]
    written = f"{head}_{{{','.join(letters[1:])}{primes}}}" if letters[1:] else head + primes
    first, _, subscript = name.partition("_")
    each_in_place = f"{first}_{{{subscript.replace('_prime', chr(39))}}}"  # I_{x'y'}
    return next((text for text in (written, each_in_place) if _is_read_as(text, name)), "")


def _is_read_as(written: str, name: str) -> bool:
    """Return whether the LaTeX ``written`` is read as a name."""
    try:
        return read_latex(f"{written} = 0").text == f"{name} == 0"
    except InputError:
        return False


class Writer:
    """A writer that turns trees into LaTeX, in which the functions of time ``timed`` have no ``(t)``."""

    def __init__(self, timed: Collection[str], vectors: Mapping[str, bool]) -> None:
        self.timed, self.vectors = timed, vectors

    def formula(self, node: Node, binding: int = 0) -> str:
        own = {"sum": SUM, "neg": SUM, "product": PRODUCT, "inv": PRODUCT}.get(node.kind, ATOM)
        own = PRODUCT if node.kind == "call" and node.value in VECTOR_SIGNS else own
        written = self.writers[node.kind](self, node)
        return f"({written})" if own < binding else written

    def number(self, node: Node) -> str:
        value = node.value
        return str(value) if value.denominator == 1 else f"\\frac{{{value.numerator}}}{{{value.denominator}}}"

    def name(self, node: Node) -> str:
        if node.value == "pi":
            return "\\pi"
        if node.value not in self.vectors and (marked := _with_marks(str(node.value))):
            return marked
        base, _, subscript = str(node.value).partition("_")
        words = [f"\\{word}" if word in GREEK else word for word in (base, subscript)]
        if node.value in self.vectors:
            words[0] = f"\\{'boldsymbol' if base in GREEK else 'mathbf'}{{{words[0]}}}"
            words[0] = f"\\hat{{{words[0]}}}" if self.vectors[str(node.value)] else words[0]
            base = base[:1]
        if len(base) > 1 and base not in GREEK:
            words[0] = f"\\mathrm{{{base}}}"
        if not subscript:
            return words[0]
        short = len(subscript) == 1 or subscript in GREEK
        pieces = re.sub("_", ",", words[1])
        return f"{words[0]}_{pieces}" if short else f"{words[0]}_{{{pieces}}}"

    def sum(self, node: Node) -> str:
        written = self.formula(node.args[0], SUM)
        for term in node.args[1:]:
            negative = term.kind == "neg"
            written += (" - " if negative else " + ") + self.formula(term.args[0] if negative else term, SUM + 1)
        return written

    def negative(self, node: Node) -> str:
        return "-" + self.formula(node.args[0], PRODUCT)

    def product(self, node: Node) -> str:
        """Return the LaTeX of a product: ``a/b*c`` becomes a fraction of a and b, and c after it."""
        pieces: list[str] = []
        last = None
        for factor in node.args:
            if factor.kind == "inv":
                above = "1" if last is None else self.formula(last)
                if last is not None:
                    pieces.pop()
                pieces.append(f"\\frac{{{above}}}{{{self.formula(factor.args[0])}}}")
                last = None
                continue
            pieces.append(self.formula(factor, PRODUCT + 1))
            last = factor
        joined = pieces[0]
        for piece in pieces[1:]:
            joined += (" \\cdot " if piece[0].isdigit() else " ") + piece
        return joined

    def inverse(self, node: Node) -> str:
        return f"\\frac{{1}}{{{self.formula(node.args[0])}}}"

    def power(self, node: Node) -> str:
        base, exponent = node.args
        raised = self.formula(exponent)
        raised = f"^{raised}" if len(raised) == 1 else f"^{{{raised}}}"
        positive = exponent.kind == "number" and exponent.value.denominator == 1
        if base.kind == "call" and base.value in COMMANDS and positive and base.value != "det":
            return f"{COMMANDS[base.value]}{raised}{self.argument(base)}"
        own_bracket = (*self.timed, "skew", "abs")
        plain = base.kind in ("name", "number") or (base.kind == "call" and base.value in own_bracket)
        return (self.formula(base) if plain else f"({self.formula(base)})") + raised

    def argument(self, call: Node) -> str:
        return f"({', '.join(map(self.formula, call.args))})"

    def call(self, node: Node) -> str:
        name = str(node.value)
        if name in VECTOR_SIGNS:
            return f" {VECTOR_SIGNS[name]} ".join(self.formula(argument, ATOM) for argument in node.args)
        if _is_dotted(node) and (node.args[0].kind == "call" or node.args[0].value in self.vectors):
            base, subscript, rest = self.name(untimed(node.args[0])).partition("_")
            return f"{DOTS[len(node.args) - 1]}{{{base}}}{subscript}{rest}"
        if name in self.timed:
            return self.name(Node("name", name))
        if name == "diff" and node.args[1:] == (TIME,):
            return f"\\frac{{d}}{{dt}}({self.formula(node.args[0])})"
        if name == "conjugate":
            return f"{self.formula(node.args[0], ATOM)}^*"
        if name == "sqrt" and _is_square(node.args[0]):
            return f"\\|{self.formula(node.args[0].args[0])}\\|"
        if name == "integrate":
            return self.integral(node)
        if name == "sqrt":
            return f"\\sqrt{{{self.formula(node.args[0])}}}"
        if name == "skew":
            return f"[{self.formula(node.args[0])}]_\\times"
        if name == "abs":
            return f"|{self.formula(node.args[0])}|"
        if name == "Matrix":
            rows = [row.args if row.kind == "list" else (row,) for row in node.args[0].args]
            lines = " \\\\ ".join(" & ".join(map(self.formula, row)) for row in rows)
            return f"\\begin{{bmatrix}} {lines} \\end{{bmatrix}}"
        if node.args == (TIME,) and name not in COMMANDS:
            return f"{self.name(Node('name', name))}(t)"
        if name in ROTATIONS:
            return self.name(Node("name", name)) + self.argument(node)
        command = COMMANDS.get(name, f"\\operatorname{{{name}}}")
        return command + self.argument(node)

    def integral(self, node: Node) -> str:
        """Return the LaTeX of an integral, whose first range is that of the innermost integral."""
        integrand, *ranges = node.args
        signs = [
            f"\\int_{{{self.formula(place.args[1])}}}^{{{self.formula(place.args[2])}}}" for place in reversed(ranges)
        ]
        differentials = [f"\\,d{self.formula(place.args[0])}" for place in ranges]
        return f"{' '.join(signs)} {self.formula(integrand, PRODUCT)} {' '.join(differentials)}"

    def transpose(self, node: Node) -> str:
        return f"{self.formula(node.args[0], ATOM)}^T"

    writers: ClassVar[Mapping[str, Callable[["Writer", Node], str]]] = {
        "number": number, "name": name, "sum": sum, "neg": negative, "product": product, "inv": inverse, "power": power,
        "call": call, "transpose": transpose,
    }  # fmt: skip
    """Kind of a tree -> the function that writes it; trees of the kinds index and list cannot be written."""
