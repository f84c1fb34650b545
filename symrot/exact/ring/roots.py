"""Roots in formulas: a fractional power becomes a rational factor times variables g of a polynomial ring.

Each variable g has a relation ``g^n = P`` with a polynomial P. ``sqrt(P/Q)`` is written ``g/|Q|`` with ``g^2 = P*Q``,
and a square under a square root is written outside as an absolute value: ``sqrt(x^2 y) = |x| sqrt(y)``. So the variable
of a square root is never negative. For other roots, ``(P/Q)^(1/n)`` is written ``g/Q`` with ``g^n = P*Q^(n-1)``.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache
from math import comb, prod

from sympy import Abs, Add, Expr, Function, I, Integer, Pow, Rational, Symbol, exp, factorint, isprime, sqrt
from sympy.core.function import AppliedUndef
from sympy.printing.str import StrPrinter

from symrot.errors import InputError
from symrot.exact.ring.ratio import TooLarge

__all__ = [
    "Radical",
    "Radicand",
    "Root",
    "absolute",
    "is_positive_where_defined",
    "is_root",
    "radical",
    "sign_of",
    "square_root_of_number",
    "written",
]

MOST_TERMS = 4000
"""Largest number of terms of a radicand; a larger one raises TooLarge.

The radicand of the n-th root of a fraction P/Q is ``P Q^(n-1)``; its terms are counted before equal ones are added."""

MOST_BITS_FACTORED, LARGEST_DIVISOR = 64, 2**15
"""Largest number of bits of a number that is factored completely; in longer numbers, only divisors below
:data:`LARGEST_DIVISOR` are sought."""


_UNORDERED = StrPrinter({"order": "none"})


# Roots that depend on each other, such as nested roots, have one variable each. An equation that follows from their
# relations is true; another one may be true too, because a root is only one branch of its relation.
@lru_cache(maxsize=20_000)
def written(node: Expr) -> str:
    """Return the text of an expression, used as a sort key that is the same in every run."""
    # to order terms, SymPy computes the values of functions of numbers, which takes seconds if they are nested
    has_values = any(part.is_number for part in node.atoms(Function))
    return str(_UNORDERED.doprint(node)) if has_values else str(node)


@dataclass(frozen=True)
class Root:
    """A root as a variable of a polynomial ring, with ``expression^index = power_expression``.

    sqrt(x + 1) has the index 2 and the power expression x + 1.
    """

    expression: Expr
    power_expression: Expr
    index: int  # also 2 for an absolute value: |x|^2 = x^2
    depth: int  # how many roots are nested in it, itself included


@dataclass(frozen=True)
class Radicand:
    """A radicand in factors: ``content * above / below``, times ``f^(2 n)`` for each pair (f, n) in ``outside``.

    Under a square root ``x^2 y / 4`` has content 1/4, above y, below 1 and outside (``|x|``, 1).
    """

    content: Rational  # >= 0
    above: Expr  # a primitive polynomial over the integers, like below
    below: Expr  # 1 under a square root
    outside: tuple[tuple[Root | Expr, int], ...] = ()  # f^n leaves a square root, f >= 0; () for other roots
    # whether an f may be zero where above is negative: there the root is real, but the root of above is not
    loose: bool = False


@dataclass(frozen=True)
class Radical:
    """A fractional power, split into factors: ``(rational * product(roots) * product(f^n) / below)^power``.

    The pairs (f, n) are in ``outside``. ``sqrt(4 x^2 y)^3 = (2 sqrt(y) |x|)^3`` has rational 2, root sqrt(y), the pair
    (``|x|``, 1), below 1 and power 3. ``below`` is a divisor that is written outside the root: a root of index k > 2
    with the radicand P/Q becomes the root of ``P Q^(k-1)``, divided by Q. For a square root, ``below`` is 1: its
    divisors are among the pairs (f, n), with n < 0.
    """

    base: Expr
    rational: Rational
    roots: tuple[Root, ...]
    below: Expr
    power: int
    outside: tuple[tuple[Root | Expr, int], ...] = ()
    # whether an f may be zero where a root is not real, as at x = 0, y = -1: there the whole power is real
    loose: bool = False

    @property
    def generators(self) -> tuple[Root, ...]:
        """All roots for which the ring needs a variable to express this fractional power.

        sqrt(x^2 y) needs sqrt(y) and the absolute value ``|x|``.
        """
        return (*self.roots, *(factor for factor, _ in self.outside if isinstance(factor, Root)))

    @property
    def parts(self) -> tuple[Expr, ...]:
        """The formulas inside this fractional power, such as radicands.

        A polynomial ring that contains the power also needs variables for the symbols and roots in these formulas.
        """
        insides = [root.power_expression for root in self.generators]
        return (self.rational, self.below, *insides, *(f for f, _ in self.outside if not isinstance(f, Root)))


def radical(node: Expr, radicand: Callable[[Expr, int], Radicand]) -> Radical:
    """Split a fractional power, the imaginary unit ``i`` or an absolute value into factors; return the factors.

    Parameters
    ----------
    node : Expr
        The power, imaginary unit or absolute value.
    radicand : function
        Function from an expression and the index of a root to the factors of the radicand.

    Raises
    ------
    InputError
        If the node is a negative power of an expression that is zero everywhere, or a root of a negative number that is
        not real: ``(-8)^(1/3)`` is ``1 + sqrt(3) i`` on the principal branch. Square roots of negative numbers are
        read as multiples of ``i``.
    """
    if node is I:
        return Radical(Integer(-1), Integer(1), (_imaginary_unit(),), Integer(1), 1)
    if isinstance(node, Abs):
        base, power, index = node.args[0] ** 2, 1, 2
    else:
        assert isinstance(node, Pow)
        base, power, index = node.base, int(node.exp.p), int(node.exp.q)
    parts = radicand(base, index)
    content, above, below = parts.content, parts.above, parts.below
    if not content:
        if power < 0:
            raise InputError(f"the formula divides by a power of {base}, which is zero everywhere")
        return Radical(base, Integer(0), (), Integer(1), 1)
    roots: list[Root] = []
    if index != 2:
        above, below = content.p * above, content.q * below
        rational = Integer(1)
    else:
        rational, roots = square_root_of_number(content)
    if above == -1 and below == 1 and index == 2:
        roots.append(_imaginary_unit())
    elif above.is_Rational and index != 2 and above * sign_of(below) < 0:
        raise InputError(f"a root of a negative number is not a real number: {node}")
    elif above != 1 or below != 1:
        terms, times = len(Add.make_args(below)), index - 1
        if len(Add.make_args(above)) * comb(terms + times - 1, times) > MOST_TERMS:
            raise TooLarge(f"the radicand of a root has more than {MOST_TERMS} terms over one denominator; simplify it")
        inside = (above * below ** (index - 1)).expand()
        written_root = below * (above / below) ** Rational(1, index)
        roots.append(Root(written_root, inside, index, 1 + _nesting([inside])))
    return Radical(base, rational, tuple(roots), below, power, parts.outside, parts.loose)


def absolute(value: Expr) -> Root | Expr:
    """Return the absolute value of a real expression x: ``x`` or ``-x`` if the sign of x is known, else a Root.

    An absolute value counts as a root, because ``|x|^2 = x^2``.
    """
    sign = sign_of(value)
    return sign * value if sign else Root(Abs(value), (value**2).expand(), 2, 1 + _nesting([value]))


def sign_of(value: Expr) -> int:
    """Return 1 for a real expression that is never negative, -1 if it is never positive, 0 if neither is known."""
    if value.is_nonnegative or is_positive_where_defined(value):
        return 1
    return -1 if value.is_nonpositive or is_positive_where_defined(-value) else 0


def is_positive_where_defined(value: Expr) -> bool:
    """Return whether a formula consists of exponentials and positive numbers, so that it is positive."""
    # SymPy does not call it positive, because its exponent might be infinite
    if isinstance(value, exp):
        return True
    if value.is_Add or value.is_Mul:
        return all(map(is_positive_where_defined, value.args))
    return bool(value.is_Rational and value > 0) or bool(value.is_Pow and is_positive_where_defined(value.base))


def is_root(node: Expr) -> bool:
    """Return whether an expression is a fractional power, ``i``, or the absolute value of a real expression."""
    if isinstance(node, Pow):
        return bool(node.exp.is_Rational and not node.exp.is_Integer)
    return node is I or (isinstance(node, Abs) and _is_real_where_defined(node.args[0]))


def _is_real_where_defined(value: Expr) -> bool:
    return bool(value.is_extended_real) or all(leaf.is_extended_real for leaf in value.atoms(Symbol, AppliedUndef))


def _imaginary_unit() -> Root:
    return Root(I, Integer(-1), 2, 1)


def square_root_of_number(value: Rational) -> tuple[Rational, list[Root]]:
    """Return (r, roots): the square root of a positive rational number is r times the product of ``roots`` of primes.

    12/5 gives 2/5, sqrt(3) and sqrt(5).
    """
    powers: dict[int, int] = {}
    for whole in (int(value.p), int(value.q)):
        for prime, power in _factors_of_number(whole).items():
            powers[prime] = powers.get(prime, 0) + power
    outside = prod(prime ** (power // 2) for prime, power in powers.items())
    primes = sorted(prime for prime, power in powers.items() if power % 2)
    return Rational(outside, value.q), [Root(sqrt(prime), Integer(prime), 2, 1) for prime in primes]


def _factors_of_number(whole: int) -> dict[int, int]:
    """Return the prime factors of a whole number with their powers; raise TooLarge if they take too long to find."""
    if whole.bit_length() <= MOST_BITS_FACTORED:
        return dict(factorint(whole))
    # only small factors, and squares and primes among the rest, are found in a short time
    powers = dict(factorint(whole, limit=LARGEST_DIVISOR, use_rho=False, use_pm1=False, use_ecm=False))
    if all(factor < LARGEST_DIVISOR**2 or isprime(factor) for factor in powers):
        return powers
    raise TooLarge(
        f"expected numbers of at most {MOST_BITS_FACTORED} bits under roots, since they must be factored; got one of "
        f"{whole.bit_length()} bits"
    )


def _nesting(expressions: Iterable[Expr]) -> int:
    """Return the depth of nested fractional powers in expressions: 0 without, 2 for sqrt(1 + sqrt(x))."""
    deepest = 0
    for node in expressions:
        below = _nesting(node.args)
        deepest = max(deepest, below + is_root(node))
    return deepest
