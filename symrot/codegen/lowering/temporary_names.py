"""Descriptive names of temporaries (intermediate results): sin_theta, q1_q2, omega_1_sq, A_minus_B, inv_det.

A product is named by its factors, a small sum by its terms, a call by the function and its argument. Otherwise the
first output that needs the temporary names it, as in ``domega_1_term_2``. A name depends only on the program and is
valid in C, C++ and Python.
"""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from symrot.formula.program import Program
from symrot.formula.tree import Node, names, rename

__all__ = ["with_names"]

LONGEST = 32  # largest number of letters of a name made of parts
MOST_TERMS = 3  # largest number of terms of a sum that is named by its terms
WORDS = {
    Fraction(1): "", Fraction(2): "two", Fraction(3): "three", Fraction(4): "four", Fraction(5): "five",
    Fraction(6): "six", Fraction(8): "eight", Fraction(1, 2): "half", Fraction(1, 3): "third",
    Fraction(1, 4): "quarter", Fraction(2, 3): "two_thirds", Fraction(3, 2): "three_halves",
}  # fmt: skip
POWERS = {1: "", 2: "_sq", 3: "_cubed"}
NOUNS = {"atan2": "angle", "sqrt": "root", "select_ge": "choice"}  # last word of a name, if the whole would be too long
RESERVED = frozenset({"size_t", "ptrdiff_t", "wchar_t", "time_t", "and_eq", "or_eq", "not_eq", "xor_eq"})


@dataclass(frozen=True)
class _Product:
    """A product from which a name is built: ``2*a/b^2`` has the coefficient 2 and the powers (a, 1), (b, -2)."""

    coefficient: Fraction
    powers: tuple[tuple[str, int], ...]

    def times(self, other: "_Product", sign: int = 1) -> "_Product":
        """Return this product times ``other``, or, if ``sign`` is -1, this product divided by ``other``."""
        powers = dict(self.powers)
        for symbol, power in other.powers:
            powers[symbol] = powers.get(symbol, 0) + sign * power
        coefficient = self.coefficient * other.coefficient**sign
        return _Product(coefficient, tuple((symbol, power) for symbol, power in powers.items() if power))

    def name(self) -> str | None:
        """Return the name of this product: ``two_q1_q2`` for ``2*q1*q2``, ``inv_sin_theta`` for ``1/sin_theta``.

        ``a/7`` is ``a_over_7``. The result is None for a mere number, for ``1/(7*a)``, and for ``7*a``, since 7 is
        neither in ``WORDS`` nor 1 over a whole number.
        """
        size = abs(self.coefficient)
        divisor = [str(size.denominator)] if size.numerator == 1 and size not in WORDS else []
        word = "" if divisor else WORDS.get(size)
        if word is None or (not any(power > 0 for _, power in self.powers) and (divisor or not self.powers)):
            return None
        over = [f"{symbol}{POWERS.get(power, f'_pow_{power}')}" for symbol, power in self.powers if power > 0]
        under = [f"{symbol}{POWERS.get(-power, f'_pow_{-power}')}" for symbol, power in self.powers if power < 0]
        under += divisor
        parts = [word] * bool(word) + over
        if under:
            parts = [*(parts or ["inv"]), *(["over"] if parts else []), *under]
        return "_".join(["minus"] * (self.coefficient < 0) + parts)


def with_names(program: Program, anonymous: Collection[str], numbers: Mapping[str, Node]) -> Program:
    """Return the program with a descriptive name for each temporary that has no name yet.

    Parameters
    ----------
    program : Program
        The program; its temporaries are in the order of computation.
    anonymous : collection of str
        The temporaries to name.
    numbers : mapping of str to Node
        Constants that are printed as numbers, each with its formula; names of temporaries are built from the formula.
    """
    arguments = program.signature.arguments
    used = {a.name for a in arguments} | {name for a in arguments for name, *_ in a.components} | set(RESERVED)
    used |= {name for name, _ in program.temporaries if name not in anonymous}
    first_output = _first_outputs(program)
    new: dict[str, str] = {}
    products: dict[str, _Product] = {}
    for constant, formula in numbers.items():
        name = _structural_name(formula, None, {}) or constant
        products[constant] = _product_of(formula, {}) or _Product(Fraction(1), ((name, 1),))
    temporaries = []
    for old, formula in program.temporaries:
        node = rename(formula, new)
        product = _product_of(node, products)
        name = old
        if old in anonymous:
            name = _structural_name(node, product, products) or ""
            if not name or len(name) > LONGEST or name in used:
                output = first_output[old]
                name = next(each for each in _numbered(f"{output}_{_noun(node)}") if each not in used)
            new[old] = name
        if product is not None and len(product.powers) <= 2:  # larger products are used by their own name
            products[name] = product
        used.add(name)
        temporaries.append((name, node))
    outputs = tuple((name, rename(node, new)) for name, node in program.outputs)
    return Program(program.signature, tuple(temporaries), outputs)


def _numbered(stem: str) -> Iterable[str]:
    number = 1
    while True:
        yield f"{stem}_{number}"
        number += 1


def _noun(node: Node) -> str:
    """Return the word that ends a name such as ``domega_1_term_2``: ``term``, or the name of the called function."""
    return NOUNS.get(node[1], str(node[1])) if node[0] == "call" else "term"


def _first_outputs(program: Program) -> dict[str, str]:
    """Return a mapping from each temporary to the first output that needs it, directly or through other temporaries."""
    first: dict[str, str] = {}
    formulas = dict(program.temporaries)
    for output, node in program.outputs:
        waiting = [node]
        while waiting:
            for name in names(waiting.pop()):
                if name in formulas and name not in first:
                    first[name] = output
                    waiting.append(formulas[name])
    return first


def _product_of(node: Node, products: Mapping[str, _Product]) -> _Product | None:
    """Return a formula such as ``2*a/b`` as a product of powers of symbols; None for others, such as ``a + b``."""
    kind = node[0]
    if kind == "number":
        return _Product(node[1], ())
    if kind == "symbol":
        # a temporary that is itself a product is replaced by its factors
        return products.get(node[1], _Product(Fraction(1), ((node[1], 1),)))
    if kind == "neg":
        inner = _product_of(node[1], products)
        return inner and _Product(-inner.coefficient, inner.powers)
    if kind in ("*", "/"):
        left, right = (_product_of(child, products) for child in node[1:])
        if left is None or right is None or (kind == "/" and not right.coefficient):
            return None
        return left.times(right, 1 if kind == "*" else -1)
    return None


def _structural_name(node: Node, product: _Product | None, products: Mapping[str, _Product]) -> str | None:
    """Return a name composed of the names in a formula, such as ``sin_theta`` for ``sin(theta)``, or None.

    It is None for formulas without a short name, such as ``7*a``, a sum of four terms, or a call with two arguments.
    ``product`` is the formula as a product, or None; ``products`` maps names of temporaries to their products.
    """
    if product is not None:
        return product.name()
    if node[0] in ("+", "-"):
        return _name_of_sum(node, products)
    if node[0] == "call" and len(node[2]) == 1:
        argument = _name_of_term(node[2][0], products)
        return argument and f"{node[1]}_{argument}"
    if node[0] == "neg":
        inner = _structural_name(node[1], None, products)
        return inner and f"minus_{inner}"
    return None


def _name_of_term(node: Node, products: Mapping[str, _Product]) -> str | None:
    """Return the name of one term of a sum, such as ``one``, ``A`` or ``two_q1``; None if it has no short name."""
    if node[0] == "number":
        word = "one" if node[1] == 1 else WORDS.get(node[1])
        return word or None
    if node[0] == "symbol":
        return str(node[1])
    product = _product_of(node, products)
    return product.name() if product else _structural_name(node, None, products)


def _name_of_sum(node: Node, products: Mapping[str, _Product]) -> str | None:
    """Return the name of a sum, such as ``A_minus_B``; None if it has many terms or a term without a short name."""
    terms: list[tuple[str, Node]] = []
    while node[0] in ("+", "-"):
        terms.insert(0, ("plus" if node[0] == "+" else "minus", node[2]))
        node = node[1]
    texts = [_name_of_term(each, products) for each in (node, *(term for _, term in terms))]
    if len(texts) > MOST_TERMS or None in texts:
        return None
    return "_".join([str(texts[0]), *(f"{sign}_{text}" for (sign, _), text in zip(terms, texts[1:], strict=True))])
