"""Formulas as text and as trees: read without ``eval``, evaluated with any kind of number. Standard library only.

A formula tree is a nested tuple, called a node::

    ("number", Fraction)   ("symbol", name)   ("neg", a)   ("call", function, (arguments,))
    ("+", a, b)   ("-", a, b)   ("*", a, b)   ("/", a, b)   ("**", a, integer)
"""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import reduce
from typing import Any

from symrot.errors import InputError

__all__ = [
    "FUNCTIONS", "LOGIC", "SWITCHING", "Node", "children", "evaluate", "names", "operations", "parse", "rename", "text",
    "vanishes", "with_children",
]  # fmt: skip

Node = tuple[Any, ...]

FUNCTIONS: dict[str, int] = {  # name -> number of arguments
    "sqrt": 1, "sin": 1, "cos": 1, "tan": 1, "exp": 1, "log": 1, "abs": 1, "sinh": 1, "cosh": 1, "tanh": 1,
    "asin": 1, "acos": 1, "atan": 1, "atan2": 2,
}  # fmt: skip
SWITCHING: dict[str, int] = {  # functions with jumps or kinks, for formulas of torques; min and max take two or more
    "step": 1, "sign": 1, "min": 2, "max": 2, "clip": 3, "floor": 1, "mod": 2, "where": 3,
}  # fmt: skip
COMPARISONS = {  # operators in the condition of where: (whether to swap the sides, whether to negate) to get "less"
    "<": (False, False), "<=": (True, True), ">": (True, False), ">=": (False, True),
}  # fmt: skip
LOGIC = {"or": 2, "and": 4}  # binding strength, below all arithmetic operators
LONGEST_TEXT = 10_000
DEEPEST_NESTING = 100
LONGEST_NUMBER = 1000
LARGEST_POWER = 64
LARGEST_EXPONENT = 400  # largest power of ten of a written number: beyond any double

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*)"
    r"|(?P<mark>\*\*|<=|>=|[-+*/(),<>]))",
    re.ASCII,
)
_BINDING = {**LOGIC, **dict.fromkeys(COMPARISONS, 6), "+": 10, "-": 10, "*": 20, "/": 20, "**": 40}
_NOT = 5
_UNARY = 30  # -x**2 is -(x**2), -x*y is (-x)*y


class _Reader:
    """A parser for one formula, by precedence climbing."""

    def __init__(self, source: str, where: str, switching: bool) -> None:
        self.source, self.where, self.depth = source, f"{where}: " if where else "", 0
        self.switching, self.functions = switching, FUNCTIONS | SWITCHING if switching else FUNCTIONS
        self.tokens = list(self._split())
        self.index = 0

    def fail(self, expected: str, position: int, function: str = "") -> InputError:
        from symrot.formula.advice import function_advice, mark_advice  # imported only for an error

        excerpt = self.source if len(self.source) <= 60 else self.source[:57] + "..."
        known = self.functions
        advice = function_advice(function, known) if function else mark_advice(self.source, position, known)
        reason = f" ({advice})" if advice else ""
        return InputError(f"{self.where}expected {expected} at position {position + 1} of {excerpt!r}{reason}")

    def _split(self) -> Iterator[tuple[str, str, int]]:
        position = 0
        while position < len(self.source.rstrip()):
            match = _TOKEN.match(self.source, position)
            if match is None or (match["mark"] in COMPARISONS and not self.switching):
                blank = len(self.source[position:]) - len(self.source[position:].lstrip())
                raise self.fail("a number, a name, an operator or a bracket", position + blank)
            kind = str(match.lastgroup)
            yield kind, match[kind], match.start(kind)
            position = match.end()
        yield "end", "", len(self.source.rstrip())

    def next(self) -> tuple[str, str, int]:
        token = self.tokens[self.index]
        self.index += token[0] != "end"
        return token

    def peek(self) -> str:
        return self.tokens[self.index][1]

    def expect(self, mark: str) -> None:
        _, token, position = self.next()
        if token != mark:
            raise self.fail(f"'{mark}'", position)

    def expression(self, binding: int = 0) -> Node:
        self.depth += 1
        if self.depth > DEEPEST_NESTING:
            raise self.fail(
                f"a formula with at most {DEEPEST_NESTING} nested levels of brackets", self.tokens[self.index][2]
            )
        left = self.operand()
        while _BINDING.get(self.peek(), 0) > binding:
            _, mark, position = self.next()
            if mark in COMPARISONS or mark in LOGIC:
                left = self.condition(mark, left)
            else:
                left = (mark, left, self.power(position) if mark == "**" else self.expression(_BINDING[mark]))
        self.depth -= 1
        return left

    def condition(self, mark: str, left: Node) -> Node:
        right = self.expression(_BINDING[mark])
        if mark in LOGIC:
            return ("call", mark, (left, right))
        turned, opposite = COMPARISONS[mark]
        less: Node = ("call", "less", (right, left) if turned else (left, right))
        return ("call", "not", (less,)) if opposite else less

    def operand(self) -> Node:
        kind, token, position = self.next()
        if self.switching and token == "not":
            return ("call", "not", (self.expression(_NOT),))
        if kind == "number":
            return ("number", self.number(token, position))
        if token == "(":
            inner = self.expression()
            self.expect(")")
            return inner
        if token == "-":
            return ("neg", self.expression(_UNARY))
        if token == "+":
            return self.expression(_UNARY)
        if kind != "name":
            raise self.fail("a number, a name or '('", position)
        if self.peek() != "(":
            return ("symbol", token)
        if token not in self.functions:
            raise self.fail(f"one of the functions {', '.join(self.functions)} instead of '{token}'", position, token)
        self.next()
        arguments = [self.expression()]
        while self.peek() == ",":
            self.next()
            arguments.append(self.expression())
        self.expect(")")
        if token in ("min", "max") and len(arguments) > 2:
            return reduce(lambda left, right: ("call", token, (left, right)), arguments)
        if len(arguments) != self.functions[token]:
            count = self.functions[token]
            plural = "s" * (count != 1)
            raise self.fail(f"{count} argument{plural} of '{token}' instead of {len(arguments)}", position, token)
        return ("call", token, tuple(arguments))

    def number(self, token: str, position: int) -> Fraction:
        exponent = re.split("[eE]", token)[1:]
        if len(token) > LONGEST_NUMBER:
            raise self.fail(f"a number of at most {LONGEST_NUMBER} characters", position)
        if exponent and (len(exponent[0]) > 5 or abs(int(exponent[0])) > LARGEST_EXPONENT):
            raise self.fail(f"an exponent of ten of at most {LARGEST_EXPONENT} instead of '{token[:20]}'", position)
        return Fraction(token)

    def power(self, position: int) -> int:
        """Read the exponent that comes next in the text, and return it.

        It is a whole number, possibly with a sign or in brackets.
        """
        brackets = self.peek() == "("
        if brackets:
            self.next()
        sign = -1 if self.peek() == "-" else 1
        if self.peek() in "+-" and self.peek():
            self.next()
        kind, token, at = self.next()
        if kind != "number" or not token.isdigit() or len(token) > 3 or int(token) > LARGEST_POWER:
            raise self.fail(f"a whole number up to {LARGEST_POWER} as exponent (write sqrt(x) for a root)", at)
        if self.peek() == "**":
            raise self.fail("brackets around a repeated power", self.tokens[self.index][2])
        if brackets and self.peek() != ")":
            raise self.fail(f"a whole number up to {LARGEST_POWER} as exponent (write sqrt(x) for a root)", at)
        if brackets:
            self.expect(")")
        return sign * int(token)


def parse(source: str, where: str = "", switching: bool = False) -> Node:
    """Return the tree of a formula that is given as text.

    Parameters
    ----------
    source : str
        Text of numbers, names, ``+ - * / **`` (whole exponents), brackets and the functions of :data:`FUNCTIONS`.
    where : str
        File and key of the text, for error messages.
    switching : bool
        Whether the functions of :data:`SWITCHING` are allowed too. One of them is ``where(condition, a, b)``, whose
        condition may have comparisons, ``and``, ``or`` and ``not``; in the tree these are calls of ``less``, ``and``,
        ``or`` and ``not``. See :mod:`symrot.formula.switches`.

    Raises
    ------
    InputError
        If the text is not such a formula; the message names the first wrong position.

    Examples
    --------
    >>> parse("-k*omega_1**2")
    ('*', ('neg', ('symbol', 'k')), ('**', ('symbol', 'omega_1'), 2))
    """
    if len(source) > LONGEST_TEXT:
        place = f"{where}: " if where else ""
        raise InputError(f"{place}expected a formula of at most {LONGEST_TEXT} characters, got {len(source)}")
    reader = _Reader(source, where, switching)
    node = reader.expression()
    kind, _, position = reader.next()
    if kind != "end":
        raise reader.fail("an operator or the end", position)
    return node


def children(node: Node) -> tuple[Node, ...]:
    """Return the operands at the root of a formula tree: (a, b) for ``("+", a, b)``.

    A number or a symbol has none.
    """
    kind = node[0]
    if kind in ("number", "symbol"):
        return ()
    if kind == "call":
        return tuple(node[2])
    return (node[1],) if kind in ("**", "neg") else (node[1], node[2])


def with_children(node: Node, parts: Sequence[Node]) -> Node:
    """Return a formula tree with other operands at its root: ``parts`` in place of :func:`children`."""
    kind = node[0]
    if kind in ("number", "symbol"):
        return node
    if kind == "call":
        return (kind, node[1], tuple(parts))
    return (kind, *parts, node[2]) if kind == "**" else (kind, *parts)


def rename(node: Node, symbols: Mapping[str, str] | None = None, functions: Mapping[str, str] | None = None) -> Node:
    """Return the formula with symbols and functions renamed as the two mappings say; other names are unchanged."""
    if node[0] == "symbol":
        return ("symbol", (symbols or {}).get(node[1], node[1]))
    if node[0] == "call":
        node = ("call", (functions or {}).get(node[1], node[1]), node[2])
    return with_children(node, [rename(child, symbols, functions) for child in children(node)])


def names(node: Node) -> set[str]:
    """Return the names of all symbols in a formula; names of functions do not count."""
    if node[0] == "symbol":
        return {node[1]}
    return set().union(*(names(child) for child in children(node)))


def operations(node: Node) -> Counter[str]:
    """Return the numbers of operations in a formula, by name: ``add`` (and subtract), ``mul``, ``neg``, ``sin``.."""
    count: Counter[str] = sum((operations(child) for child in children(node)), Counter())
    kind = node[0]
    if kind == "**":
        # x^-3 is two multiplications and a division
        count["mul"] += max(abs(node[2]) - 1, 0)
        count["div"] += node[2] < 0
    elif kind not in ("number", "symbol"):
        count[{"+": "add", "-": "add", "*": "mul", "/": "div", "neg": "neg", "call": node[1]}[kind]] += 1
    return +count


ODD = {"sqrt", "sin", "tan", "sinh", "tanh", "asin", "atan", "abs"}  # functions that are zero at zero


def vanishes(node: Node, zeros: Collection[str]) -> bool:
    """Return whether a formula, as it is written, is zero if the symbols ``zeros`` are zero.

    ``a*b`` is zero if a is zero; terms that cancel are not recognised: ``x - x`` gives False.
    """
    kind = node[0]
    if kind in ("number", "symbol"):
        return node[1] == 0 if kind == "number" else node[1] in zeros
    parts = [vanishes(part, zeros) for part in children(node)]
    if kind == "*":
        return any(parts)
    if kind == "call":
        return node[1] in ODD and parts[0]
    return parts[0] and (kind not in "+-" or parts[1]) and (kind != "**" or node[2] > 0)


def evaluate(
    node: Node,
    values: Mapping[str, Any],
    functions: Mapping[str, Callable[..., Any]] | None = None,
    number: Callable[[Fraction], Any] = lambda value: value,
) -> Any:
    """Return the value of a formula, given the values of its symbols: Fractions, floats, arrays or SymPy expressions.

    Parameters
    ----------
    node : Node
        The formula.
    values : mapping of str to number
        A value for each symbol.
    functions : mapping of str to callable, optional
        Implementations of the functions, by name, for the kind of number in ``values``.
    number : callable
        Converts the exact constants of the formula to this kind of number; ``float`` for arrays.

    Raises
    ------
    KeyError
        If a symbol has no value, or a function has no implementation.
    """
    kind = node[0]
    if kind == "number":
        return number(node[1])
    if kind == "symbol":
        return values[node[1]]
    if kind == "call":
        return (functions or {})[node[1]](*(evaluate(child, values, functions, number) for child in node[2]))
    left = evaluate(node[1], values, functions, number)
    if kind == "neg":
        return -left
    if kind == "**":
        return left ** node[2]
    right = evaluate(node[2], values, functions, number)
    if kind == "+":
        return left + right
    if kind == "-":
        return left - right
    return left * right if kind == "*" else left / right


_INFIX = {"+": (10, " + "), "-": (10, " - "), "*": (20, "*"), "/": (20, "/")}


def text(node: Node, binding: int = 0, literal: Callable[[Fraction], str] = str) -> str:
    """Return a formula as infix text, with brackets that preserve its order of evaluation.

    Parameters
    ----------
    node : Node
        The formula.
    binding : int
        How strongly the operator around the formula binds, from 0 (no operator) to 41 (base of a power). An operation
        that binds less strongly gets brackets: ``a + b`` does for 11 and more.
    literal : callable
        Returns a number of the formula as text, such as a literal of C.
    """
    kind = node[0]
    if kind == "number":
        # parse reads the same tree from the text, except that a fraction becomes a quotient, and -2 becomes a negation
        number_text = literal(node[1])
        loose = binding > 10 and ("/" in number_text or number_text.startswith("-"))
        return f"({number_text})" if loose else number_text
    if kind == "symbol":
        return str(node[1])
    if kind == "call" and node[1] in ("less", *LOGIC):
        mark = "<" if node[1] == "less" else node[1]
        inner = f" {mark} ".join(text(child, _BINDING[mark] + 1, literal) for child in node[2])
        return f"({inner})" if binding > _BINDING[mark] else inner
    if kind == "call" and node[1] == "not":
        return f"not {text(node[2][0], _NOT, literal)}"
    if kind == "call":
        return f"{node[1]}({', '.join(text(child, 0, literal) for child in node[2])})"
    if kind == "neg":
        inner = "-" + text(node[1], _UNARY, literal)
        return f"({inner})" if binding > 10 else inner
    if kind == "**":
        power = str(node[2]) if node[2] >= 0 else f"({node[2]})"
        inner = f"{text(node[1], 41, literal)}**{power}"
        return f"({inner})" if binding > 40 else inner
    own, mark = _INFIX[kind]
    inner = f"{text(node[1], own, literal)}{mark}{text(node[2], own + 1, literal)}"
    return f"({inner})" if binding > own else inner
