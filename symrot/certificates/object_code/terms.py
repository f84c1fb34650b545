"""Symbolic values of machine code, simplified on creation by laws that keep every bit.

A term stands for 32 or 64 bits, and is passed as its index in the store :class:`Terms`. Equal indices mean equal bits
on every input, in rounding to nearest, except that all NaNs count as equal.
"""

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from math import isfinite
from struct import pack, unpack
from typing import Any

__all__ = [
    "ANY",
    "EQUAL",
    "GREATER",
    "LESS",
    "RELATION",
    "UNORDERED",
    "Known",
    "Outcomes",
    "Pair",
    "Term",
    "Terms",
    "number_from_bits",
]

Term = tuple[Any, ...]
Outcomes = frozenset[str]
Pair = tuple[int, int]
Known = Mapping[Pair, Outcomes]

LESS, EQUAL, GREATER, UNORDERED = "<", "=", ">", "?"
ANY: Outcomes = frozenset((LESS, EQUAL, GREATER, UNORDERED))
RELATION: dict[str, Outcomes] = {
    "<": frozenset("<"), "<=": frozenset("<="), ">": frozenset(">"), ">=": frozenset(">="), "==": frozenset("="),
    "!=": frozenset("<>?"),
}  # fmt: skip
_SWAPPED = {LESS: GREATER, GREATER: LESS, EQUAL: EQUAL, UNORDERED: UNORDERED}
_FORMATS = {32: ("<f", "<I"), 64: ("<d", "<Q")}
_FIRST_OPERAND: dict[str, int] = {  # kind -> place of its first operand; the rest of the tuple are operands
    "mul": 2, "add": 2, "div": 2, "neg": 2, "abs": 2, "sqrt": 2, "sign": 2, "and": 2, "or": 2, "xor": 2, "andn": 2,
    "fma": 2, "fnma": 2, "choose": 2, "mask": 3, "call": 3, "join": 2, "part": 3,
}  # fmt: skip


def number_from_bits(bits: int, width: int) -> float:
    """Return the floating-point number that an integer of 32 or 64 bits encodes."""
    number, whole = _FORMATS[width]
    return float(unpack(number, pack(whole, bits))[0])


def _bits_from_number(value: float, width: int) -> int | None:
    """Return the bits of the float or double of ``width`` bits nearest to ``value``; None for NaN or overflow."""
    number, whole = _FORMATS[width]
    try:
        return None if value != value else int(unpack(whole, pack(number, value))[0])
    except OverflowError:
        return None


def swapped(outcomes: Iterable[str]) -> Outcomes:
    """Return ``outcomes`` of comparing a with b as outcomes of comparing b with a: less becomes greater."""
    return frozenset(_SWAPPED[item] for item in outcomes)


# The laws hold also under overflow and underflow, and for signed zeros:
#     a - b = a + (-b)      a + b = b + a      a*b = b*a      (-a)*b = -(a*b)      (-a)/b = a/(-b) = -(a/b)
#     a + a = 2*a           2^j*(2^k*a) = 2^(j+k)*a, j, k >= 0                     a/2^k = a*2^-k
#     1*a = a               a + (-0) = a       a*copysign(1, b) = a with its sign changed by that of b
#     a < b = b > a = -b < -a
# Operations on single bits are exact: sign bits, numbers without sign, and masks (all bits 1 or all 0).
# Not a law: -(a + b) = (-a) + (-b), which fails in the sign of a sum that is zero; nor any law that moves a rounding.
class Terms:
    """A store of symbolic terms, in which equal terms have one index; methods pass terms by index."""

    def __init__(self) -> None:
        self.nodes: list[Term] = []
        self.places: dict[Term, int] = {}

    def _add(self, *term: Any) -> int:
        if term not in self.places:
            self.places[term] = len(self.nodes)
            self.nodes.append(term)
        return self.places[term]

    def width(self, a: int) -> int:
        """Return the number of bits of the value for which the term ``a`` stands, 32 or 64."""
        return int(self.nodes[a][1])

    def kind(self, a: int) -> str:
        """Return the kind of the term ``a``: the operation that gives its value, such as ``"add"`` or ``"call"``."""
        return str(self.nodes[a][0])

    # --- leaves ---------------------------------------------------------------------------------------------------

    def input(self, width: int, place: str) -> int:
        """Return the term for an input component, such as ``"q[1]"``, a number of ``width`` bits."""
        return self._add("in", width, place)

    def bits(self, width: int, value: int) -> int:
        """Return the constant term of ``width`` bits that encode the integer ``value``."""
        return self._add("bits", width, value & ((1 << width) - 1))

    def number(self, width: int, value: Fraction) -> int:
        """Return the constant term for ``value``; raise ValueError if ``width`` bits cannot represent it exactly."""
        bits = _bits_from_number(float(value), width)
        if bits is None or Fraction(number_from_bits(bits, width)) != value:
            raise ValueError(f"expected a number that {width} bits represent exactly, got {value}")
        return self.bits(width, bits)

    def unknown(self, byte: int | None = None) -> int:
        """Return a new 32-bit term about whose value nothing is known, except its lowest byte if ``byte`` is passed."""
        return self._add("unknown", 32, len(self.nodes), byte)

    def lowest_byte(self, a: int) -> int | None:
        """Return the lowest byte of the 32-bit value of the term ``a``, or None if the byte is not known."""
        value = self.nodes[a][3] if self.kind(a) == "unknown" else self.constant(a)
        return None if value is None else int(value) & 0xFF

    def token(self, name: str) -> int:
        """Return a named 64-bit term about which nothing is known, such as a register's content before the call."""
        return self._add("token", 64, name)

    def address(self, base: str, offset: int) -> int:
        """Return the term for an address: an offset from a base (an array, the stack, a section or a symbol)."""
        return self._add("address", 64, base, offset)

    def constant(self, a: int) -> int | None:
        """Return the value of the term ``a``, as the integer that its bits encode, if it is constant; else None."""
        return self.nodes[a][2] if self.nodes[a][0] == "bits" else None

    def _value(self, a: int) -> float | None:
        bits = self.constant(a)
        return None if bits is None else number_from_bits(bits, self.width(a))

    # --- words: a 64-bit term consists of two 32-bit terms --------------------------------------------------------

    def word(self, a: int, part: int) -> int:
        """Return the term for half of the 64-bit term ``a``: the low 32 bits if ``part`` is 0, the high ones if 1."""
        node = self.nodes[a]
        if node[0] == "bits":
            return self.bits(32, node[2] >> 32 * part)
        return int(node[2 + part]) if node[0] == "join" else self._add("part", 32, part, a)

    def join(self, low: int, high: int) -> int:
        """Return the 64-bit term whose 32-bit halves are ``low`` and ``high``."""
        first, second = self.nodes[low], self.nodes[high]
        if first[0] == "bits" and second[0] == "bits":
            return self.bits(64, first[2] | second[2] << 32)
        if first[0] == second[0] == "part" and (first[2], second[2]) == (0, 1) and first[3] == second[3]:
            return int(first[3])
        return self._add("join", 64, low, high)

    # --- bits ---------------------------------------------------------------------------------------------------------

    def _ones(self, a: int) -> int:
        return (1 << self.width(a)) - 1

    def _sign_bit(self, a: int) -> int:
        return 1 << self.width(a) - 1

    def bit_and(self, a: int, b: int) -> int:
        """Return the term ``a & b``."""
        if self.constant(b) is None:
            a, b = b, a
        mask, width = self.constant(b), self.width(a)
        if mask is not None:
            value = self.constant(a)
            if value is not None:
                return self.bits(width, value & mask)
            special: dict[int, Callable[[], int]] = {
                0: lambda: b, self._ones(a): lambda: a, self._sign_bit(a): lambda: self.sign(a),
                self._sign_bit(a) - 1: lambda: self.abs(a),
            }  # fmt: skip
            if mask in special:
                return special[mask]()
        return a if a == b else self._add("and", width, *sorted((a, b)))

    def bit_andn(self, a: int, b: int) -> int:
        """Return the term ``~a & b``."""
        mask = self.constant(a)
        if mask is not None:
            return self.bit_and(self.bits(self.width(a), ~mask), b)
        if self.constant(b) == 0 or a == b:
            return self.bits(self.width(a), 0)
        return self._add("andn", self.width(a), a, b)

    def bit_or(self, a: int, b: int) -> int:
        """Return the term ``a | b``."""
        if self.constant(b) is None:
            a, b = b, a
        mask, value = self.constant(b), self.constant(a)
        if mask is not None and value is not None:
            return self.bits(self.width(a), value | mask)
        if mask == 0 or a == b:
            return a
        if mask == self._ones(a):
            return b
        return self._add("or", self.width(a), *sorted((a, b)))

    def bit_xor(self, a: int, b: int) -> int:
        """Return the term ``a ^ b``."""
        if self.constant(b) is None:
            a, b = b, a
        mask, value, width = self.constant(b), self.constant(a), self.width(a)
        if a == b:
            return self.bits(width, 0)
        if mask is not None:
            if value is not None:
                return self.bits(width, value ^ mask)
            if mask == 0:
                return a
            if mask == self._sign_bit(a):
                return self.neg(a)
            if mask == self._ones(a) and self.kind(a) == "mask":
                return self.mask(width, ANY - self.nodes[a][2], *self.nodes[a][3:])
        return self._add("xor", width, *sorted((a, b)))

    def neg(self, a: int) -> int:
        """Return the term ``-a``: the bits of ``a`` with the sign bit inverted."""
        node = self.nodes[a]
        if node[0] == "bits":
            return self.bits(node[1], node[2] ^ self._sign_bit(a))
        return int(node[2]) if node[0] == "neg" else self._add("neg", node[1], a)

    def abs(self, a: int) -> int:
        """Return the term ``|a|``: the bits of ``a`` with the sign bit cleared."""
        node = self.nodes[a]
        if node[0] == "bits":
            return self.bits(node[1], node[2] & (self._sign_bit(a) - 1))
        if node[0] == "abs":
            return a
        return self.abs(node[2]) if node[0] == "neg" else self._add("abs", node[1], a)

    def sign(self, a: int) -> int:
        """Return the term that has the sign bit of ``a``, with all other bits 0."""
        node = self.nodes[a]
        if node[0] == "bits":
            return self.bits(node[1], node[2] & self._sign_bit(a))
        if node[0] in ("abs", "sign"):
            return a if node[0] == "sign" else self.bits(node[1], 0)
        return self._add("sign", node[1], a)

    def copysign(self, a: int, b: int) -> int:
        """Return the term that has the magnitude of ``a`` and the sign of ``b``."""
        return self.bit_or(self.abs(a), self.sign(b))

    # --- rounded operations -------------------------------------------------------------------------------------------

    def _folded(self, a: int, b: int, operation: Callable[[float, float], float]) -> int | None:
        """Return ``operation`` of two finite constant terms as a constant term; None for others or on overflow."""
        x, y = self._value(a), self._value(b)
        if x is None or y is None or not (isfinite(x) and isfinite(y)):
            return None
        # Python computes in double and rounds to float, which is correct: double has more than twice the digits
        bits = _bits_from_number(operation(x, y), self.width(a))
        return None if bits is None else self.bits(self.width(a), bits)

    def _signed(self, a: int) -> tuple[int, bool]:
        """Return the term ``a`` without its minus sign, and whether it had one: (b, True) if ``a`` is -b."""
        if self.kind(a) == "neg":
            return int(self.nodes[a][2]), True
        value = self.constant(a)
        return (self.neg(a), True) if value is not None and value & self._sign_bit(a) else (a, False)

    def add(self, a: int, b: int) -> int:
        """Return the term for ``a + b``, rounded to the nearest floating-point number."""
        folded = self._folded(a, b, lambda x, y: x + y)
        if folded is not None:
            return folded
        if a == b:
            return self.mul(self.number(self.width(a), Fraction(2)), a)
        for first, second in ((a, b), (b, a)):
            if self.constant(second) == self._sign_bit(second):
                return first
        return self._add("add", self.width(a), *sorted((a, b)))

    def sub(self, a: int, b: int) -> int:
        """Return the term for ``a - b``, rounded to the nearest floating-point number."""
        return self.add(a, self.neg(b))

    def mul(self, a: int, b: int) -> int:
        """Return the term for ``a*b``, rounded to the nearest floating-point number."""
        folded = self._folded(a, b, lambda x, y: x * y)
        if folded is not None:
            return folded
        (a, first), (b, second) = self._signed(a), self._signed(b)
        product = self._product(a, b)
        return self.neg(product) if first != second else product

    def _product(self, a: int, b: int) -> int:
        if self.constant(b) is None:
            a, b = b, a
        factor, width = self._value(b), self.width(a)
        if factor == 1.0:
            return a
        if factor is not None and factor >= 2.0 and _is_power_of_two(factor) and self.kind(a) == "mul":
            for inner, other in (self.nodes[a][2:], self.nodes[a][:1:-1]):
                scale = self._value(inner)
                if scale is not None and scale >= 2.0 and _is_power_of_two(scale):
                    both = _bits_from_number(scale * factor, width)
                    if both is not None and isfinite(number_from_bits(both, width)):
                        return self._add("mul", width, *sorted((self.bits(width, both), other)))
        one = self.number(width, Fraction(1))
        for item, other in ((a, b), (b, a)):
            if self.kind(item) == "or" and one in self.nodes[item][2:]:
                (sign,) = [part for part in self.nodes[item][2:] if part != one] or [one]
                if self.kind(sign) == "sign":
                    return self.bit_xor(other, sign)
        return self._add("mul", width, *sorted((a, b)))

    def div(self, a: int, b: int) -> int:
        """Return the term for ``a/b``, rounded to the nearest floating-point number."""
        if self._value(b) != 0.0:
            folded = self._folded(a, b, lambda x, y: x / y)
            if folded is not None:
                return folded
        (a, first), (b, second) = self._signed(a), self._signed(b)
        divisor = self._value(b)
        if divisor is not None and divisor != 0.0 and isfinite(divisor) and _is_power_of_two(divisor):
            inverse = _bits_from_number(1.0 / divisor, self.width(a))
            if inverse is not None and _is_inverse(number_from_bits(inverse, self.width(a)), divisor):
                return self.mul(self.neg(a) if first != second else a, self.bits(self.width(a), inverse))
        quotient = self._add("div", self.width(a), a, b)
        return self.neg(quotient) if first != second else quotient

    def sqrt(self, a: int) -> int:
        """Return the term for the square root of ``a``, rounded to the nearest floating-point number."""
        return self._add("sqrt", self.width(a), a)

    def fma(self, a: int, b: int, c: int) -> int:
        """Return the term for the fused multiply-add ``a*b + c``, rounded once."""
        (a, first), (b, second) = self._signed(a), self._signed(b)
        return self._add("fnma" if first != second else "fma", self.width(a), *sorted((a, b)), c)

    def call(self, name: str, width: int, arguments: Iterable[int]) -> int:
        """Return the term for the value of a C function, such as ``sin(x)``, whose result has ``width`` bits."""
        return self._add("call", width, name, *arguments)

    def opaque(self, name: str, width: int, *arguments: int) -> int:
        """Return a term for the result of an instruction, such as ``rcpps``, that rounds unlike every C operation."""
        return self.call(f"[{name}]", width, arguments)

    # --- choices ------------------------------------------------------------------------------------------------------

    def compared(self, outcomes: Outcomes, a: int, b: int) -> tuple[Outcomes, int, int]:
        """Return (outcomes, a, b), a comparison in normal form, so that ``a < b`` and ``b > a`` become the same.

        ``outcomes`` are the results for which the comparison of the terms a and b is true: a set of ``"<"``, ``"="``,
        ``">"`` and ``"?"`` (unordered, if a or b is NaN).
        """
        zero = self.bits(self.width(a), 0)
        a, b = (zero if self._value(item) == 0.0 else item for item in (a, b))
        if self.constant(a) is not None and self.constant(b) is None:
            a, b, outcomes = b, a, swapped(outcomes)
        if self.kind(a) == "neg" and (self.kind(b) == "neg" or self.constant(b) is not None):
            a, b, outcomes = int(self.nodes[a][2]), self.neg(b), swapped(outcomes)
            b = zero if self._value(b) == 0.0 else b
        if self.constant(b) is None and b < a:
            a, b, outcomes = b, a, swapped(outcomes)
        return outcomes, a, b

    def mask(self, width: int, outcomes: Outcomes, a: int, b: int) -> int:
        """Return the term whose bits are all 1 if comparing ``a`` with ``b`` has one of ``outcomes``, else all 0."""
        outcomes, a, b = self.compared(outcomes, a, b)
        x, y = self._value(a), self._value(b)
        if x is not None and y is not None:
            outcome = UNORDERED if x != x or y != y else EQUAL if x == y else LESS if x < y else GREATER
            return self.bits(width, -1 if outcome in outcomes else 0)
        if outcomes in (frozenset(), ANY):
            return self.bits(width, -1 if outcomes else 0)
        return self._add("mask", width, outcomes, a, b)

    def choose(self, mask: int, x: int, y: int) -> int:
        """Return the term that is ``x`` if all bits of the term ``mask`` are 1, and ``y`` if all are 0."""
        decided = self.constant(mask)
        if decided is not None and decided in (0, self._ones(mask)):
            return x if decided else y
        return x if x == y else self._add("choose", self.width(x), mask, x, y)

    # --- the whole graph ----------------------------------------------------------------------------------------------

    def operands(self, a: int) -> tuple[int, ...]:
        """Return the terms from which the value of the term ``a`` is computed; empty for inputs and constants."""
        node = self.nodes[a]
        return tuple(node[_FIRST_OPERAND[node[0]] :]) if node[0] in _FIRST_OPERAND else ()

    def order(self, roots: Iterable[int]) -> list[int]:
        """Return the terms ``roots`` and all terms on which these depend; each term comes after its operands."""
        seen: set[int] = set()
        ordered: list[int] = []
        stack = [(root, False) for root in reversed(list(roots))]
        while stack:
            index, ready = stack.pop()
            if ready:
                ordered.append(index)
            elif index not in seen:
                seen.add(index)
                stack.append((index, True))
                stack += [(operand, False) for operand in reversed(self.operands(index))]
        return ordered

    def rebuilt(self, roots: Iterable[int], known: Known, fused: bool = True) -> list[int]:
        """Return the terms ``roots``, simplified by the comparison outcomes that ``known`` leaves possible.

        If ``fused`` is false, each fused a*b + c becomes a rounded product and a rounded sum.
        """
        roots = list(roots)
        new: dict[int, int] = {}
        for index in self.order(roots):
            node, first = self.nodes[index], _FIRST_OPERAND.get(self.kind(index))
            if first is None:
                new[index] = index
                continue
            operands = [new[operand] for operand in node[first:]]
            # a rounded product and a rounded sum replace the fused multiply-add
            if node[0] in ("fma", "fnma") and not fused:
                product = self.mul(*operands[:2])
                new[index] = self.add(product if node[0] == "fma" else self.neg(product), operands[2])
            elif node[0] == "mask":
                new[index] = self._decided(node[1], node[2], operands, known)
            else:
                new[index] = self._reconstructed(node, operands)
        return [new[root] for root in roots]

    def _decided(self, width: int, outcomes: Outcomes, operands: list[int], known: Known) -> int:
        mask = self.mask(width, outcomes, *operands)
        if self.kind(mask) == "mask":
            _, _, outcomes, a, b = self.nodes[mask]
            possible = known.get((a, b), ANY)
            if possible <= outcomes or not possible & outcomes:
                return self.bits(width, -1 if possible <= outcomes else 0)
        return mask

    def _reconstructed(self, node: Term, operands: list[int]) -> int:
        kind = node[0]
        if kind == "call":
            return self.call(node[2], node[1], operands)
        if kind == "part":
            return self.word(operands[0], node[2])
        if kind == "fnma":
            return self.fma(self.neg(operands[0]), *operands[1:])
        return int(_CONSTRUCTORS[kind](self, *operands))

    def without_signs_of_zero(self, roots: Iterable[int]) -> list[int]:
        """Return the terms ``roots``, simplified by -(a + b) = (-a) + (-b); only the signs of zeros may change."""
        # for -0 + 0 the two sides differ
        roots = list(roots)
        new: dict[int, int] = {}
        for index in self.order(roots):
            kind, operands = self.kind(index), [new[operand] for operand in self.operands(index)]
            if kind == "add":
                (a, first), (b, second) = sorted(map(self._signed, operands))
                total = self.add(a, self.neg(b) if first != second else b)
                new[index] = self.neg(total) if first else total
            # not in divisors, arguments of functions and signs: there the sign of a zero would change the value
            elif kind == "div":
                new[index] = self.div(operands[0], self.operands(index)[1])
            elif kind in ("mul", "neg", "abs", "sqrt"):
                new[index] = self._reconstructed(self.nodes[index], operands)
            else:
                new[index] = index
        return [new[root] for root in roots]

    def undecided(self, roots: Iterable[int]) -> int | None:
        """Return the first comparison of unknown outcome among the terms from which ``roots`` are computed.

        ``roots`` are terms, such as outputs; the result is a term of the kind ``"mask"``, or None if there is none.
        """
        # none of its operands contains another such comparison, so that a case distinction may begin with it
        return next((index for index in self.order(roots) if self.kind(index) == "mask"), None)


def _is_power_of_two(value: float) -> bool:
    if not isfinite(value):
        return False
    top, bottom = Fraction(value).as_integer_ratio()
    return top & (top - 1) == 0 and bottom & (bottom - 1) == 0 and top > 0


def _is_inverse(value: float, divisor: float) -> bool:
    return isfinite(value) and Fraction(value) * Fraction(divisor) == 1


_CONSTRUCTORS: dict[str, Callable[..., int]] = {
    "mul": Terms.mul, "add": Terms.add, "div": Terms.div, "neg": Terms.neg, "abs": Terms.abs, "sqrt": Terms.sqrt,
    "sign": Terms.sign, "and": Terms.bit_and, "or": Terms.bit_or, "xor": Terms.bit_xor, "andn": Terms.bit_andn,
    "fma": Terms.fma, "choose": Terms.choose, "join": Terms.join,
}  # fmt: skip
