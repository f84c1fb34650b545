"""Check kernels from their files alone: ``python recheck.py NAME.cert.json ..``. It needs Python but not symrot.

Each C function must compute the formulas of its certificate, the formulas must obey their laws, and rounding errors
must be within their bounds. All this is tested at random points. Proofs, theorems of Coq and object code are not
checked.
"""

# What is checked
# ---------------
# Files (`certified`): the seal of the certificate and the hash of every file that it names.
# C text (`check_precision`): each function computes the formulas of the certificate. Both are evaluated at one random
# point, exactly, in fractions. There, sin(x) is a random number that depends on x alone, and a choice ``a < b ? x : y``
# is a mean of x and y with a random weight that depends on a and b alone. Two texts that differ as rational expressions
# of their functions and choices agree there with negligible probability. Identities of functions, such as sin^2 + cos^2
# = 1, do not hold for such random numbers, so a C text may not rely on identities.
# Series (`check_series`): a polynomial that replaces a function near a removable singularity is close enough to the
# function at 64 random points.
# Laws (`check_law`): the formulas obey the laws, to 60 digits, at 8 random points with coordinates up to 1000 (64
# points if there are choices). A smaller violation, or a violation near few points or farther out, is not noticed;
# `symrot audit` proves laws.
# Rounding (`check_rounding`): at one random point of the box, the outputs computed as C computes them have errors
# within the bounds. So a text with ``(x + 1e20) - 1e20`` for x is refused, although both are equal in exact arithmetic.
# Header (`check_header`): it declares the functions of the C file and defines only the known macros.
#
# What is not checked
# -------------------
# Proofs of laws, theorems of Coq, operation counts, flags, object code, the domain, and NumPy texts beyond their hash;
# nor that a kernel computes what its name promises: all files must agree on the name, but only `symrot audit` knows its
# meaning.
# Certificates of time steps (`symrot emit SCENE --step METHOD`): they are refused, and `symrot audit` checks them.

# mypy: ignore-errors
import json
import math
import operator
import re
import sys
from ctypes import c_double, c_float
from decimal import Context, Decimal, localcontext
from fractions import Fraction
from functools import cache
from hashlib import sha256
from pathlib import Path
from secrets import randbelow
from typing import NamedTuple

PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803482534211707")
DIGITS = Context(prec=190, Emax=120)  # arithmetic of laws and exact values; after an overflow another point is drawn
LARGEST_FILE = 16_000_000  # bytes
LONGEST_TEXT = 200_000  # words of a function or formula, including the functions that it calls
LONGEST_NUMBER = 50_000  # binary digits of a numerator or denominator
MATH_HEADER_SHA256 = "d25d5ab44d3bae69422acb133619e7f070423bbb9697d13d5fd1299221c77b2c"  # of symrot_math.h

FUNCTIONS = {"sin": 1, "cos": 1, "sqrt": 1, "atan2": 2, "copysign": 2}  # name -> number of arguments
FUNCTIONS |= dict.fromkeys(("tan", "asin", "acos", "atan", "exp", "log", "sinh", "cosh", "tanh"), 1)
FORMULA_FUNCTIONS = FUNCTIONS | {"Abs": 1}
C_FUNCTIONS = FUNCTIONS | {"fabs": 1}
VECTOR_FUNCTIONS = {"symrot_sin": 1, "symrot_cos": 1, "symrot_atan2": 2}  # of symrot_math.h
FORMULA_CHOICES = {"select_lt": "<", "select_eq": "==", "select_ge": ">="}  # f(a, b, x, y) = a < b ? x : y
VECTOR_CHOICES = {"symrot_select_lt": "<", "symrot_select_eq": "==", "symrot_choose_ge": ">="}  # of symrot_math.h
COMPARISONS = {"<": operator.lt, "==": operator.eq, ">=": operator.ge}


def need(holds, sentence):
    """Raise ValueError with the message ``sentence``, so that the certificate is refused, unless ``holds`` is true."""
    if not holds:
        raise ValueError(sentence)


def quoted(value):
    """Return a value as text for a message, shortened to 60 characters."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


# --- expressions ------------------------------------------------------------------------------------------------------
# The method value(numbers, names) of a node returns its value; ``numbers`` is an arithmetic of the next section, and
# ``names`` maps the names of variables to their values.


class Number(NamedTuple):
    """A node of an expression tree: a number in a formula, with its exact value."""

    number: Fraction

    def value(self, numbers, names):
        return numbers.number(self.number)


class Literal(NamedTuple):
    """A node of an expression tree: a number in a C text, as the double or float that C rounds it to."""

    number: float

    def value(self, numbers, names):
        return numbers.literal(self.number)


class Variable(NamedTuple):
    """A node of an expression tree: a variable, by its name or as a pair (array, component)."""

    name: str | tuple[str, int]

    def value(self, numbers, names):
        return names[self.name]


class Negative(NamedTuple):
    """A node of an expression tree: an operand with a minus sign."""

    operand: object

    def value(self, numbers, names):
        return numbers.negate(self.operand.value(numbers, names))


class Chain(NamedTuple):
    """A node of an expression tree: a sum or a product; ``rest`` is [("-", b), ("+", c)] for ``a - b + c``."""

    first: object
    rest: list

    def value(self, numbers, names):
        total = self.first.value(numbers, names)
        for operation, operand in self.rest:
            total = numbers.operate(operation, total, operand.value(numbers, names))
        return total


class Power(NamedTuple):
    """A node of an expression tree: an integer power of an operand, or of the operand's square root."""

    operand: object
    exponent: int

    def value(self, numbers, names):
        return numbers.power(self.operand.value(numbers, names), self.exponent)


class Call(NamedTuple):
    """A node of an expression tree: a call of a mathematical function, such as ``sin(x)``."""

    function: str
    arguments: list

    def value(self, numbers, names):
        return numbers.apply(self.function, [argument.value(numbers, names) for argument in self.arguments])


class Choice(NamedTuple):
    """A node of an expression tree: ``a < b ? x : y``, where the comparison may also be ``>=`` or ``==``."""

    comparison: str
    a: object
    b: object
    x: object
    y: object

    def value(self, numbers, names):
        a, b = self.a.value(numbers, names), self.b.value(numbers, names)
        return numbers.choose(
            self.comparison, a, b, lambda: self.x.value(numbers, names), lambda: self.y.value(numbers, names)
        )


class Definition(NamedTuple):
    """A function that a certificate or a C text defines: its local variables, then the expression of its value."""

    parameters: list
    local: list  # of (name, expression)
    result: object
    weight: int  # words to read for one call

    def call(self, numbers, arguments):
        names = dict(zip(self.parameters, arguments, strict=True))
        for name, expression in self.local:
            names[name] = expression.value(numbers, names)
        return self.result.value(numbers, names)


class OwnCall(NamedTuple):
    """A node of an expression tree: a call of a function that the certificate or the C text itself defines."""

    definition: Definition
    arguments: list

    def value(self, numbers, names):
        return self.definition.call(numbers, [argument.value(numbers, names) for argument in self.arguments])


# --- arithmetics ------------------------------------------------------------------------------------------------------


OPERATIONS = {"+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv}


class Arithmetic:
    """The operations on one kind of number, with which expressions are evaluated; a base class."""

    def __init__(self):
        self.drawn = {}  # (function, *arguments) or (comparison, a, b) -> random number

    # two formulas are compared by their values at one random point; functions without a value get a random one there
    def random(self, *key):
        """Return a random number; the same key always gives the same number."""
        if key not in self.drawn:
            self.drawn[key] = self.draw()
        return self.drawn[key]

    def negate(self, x):
        return -x

    def operate(self, operation, x, y):
        return OPERATIONS[operation](x, y)

    def choose(self, comparison, a, b, x, y):
        """Return ``x()`` if the comparison of ``a`` with ``b`` holds, else ``y()``; only that function is called."""
        return x() if COMPARISONS[comparison](a, b) else y()


class AnyFunctions(Arithmetic):
    """An arithmetic of exact fractions in which functions such as sine have random values.

    A conditional ``a < b ? x : y`` is a mean of x and y, with a random weight that depends on a and b alone.
    """

    def __init__(self):
        super().__init__()
        self.constants = {}  # double or float -> the number that it represents: pi, 1/3
        self.near_angles = set()  # arguments of symrot_sin and symrot_cos

    def draw(self):
        return Fraction(randbelow(2**99) - 2**98)

    def number(self, number):
        return number

    def literal(self, number):
        return self.constants.get(number, Fraction(number))

    def operate(self, operation, x, y):
        return self.short(OPERATIONS[operation](x, y))

    def power(self, x, exponent):
        need(isinstance(exponent, int), "expected whole powers in formulas, got a root: write it as sqrt(..)")
        self.short(x, abs(exponent))
        return x**exponent

    def short(self, x, times=1):
        """Return the number ``x``; raise ValueError if ``x**times`` would have too many digits."""
        digits = max(x.numerator.bit_length(), x.denominator.bit_length()) * times
        need(digits <= LONGEST_NUMBER, f"expected numbers of at most {LONGEST_NUMBER} binary digits, got longer ones")
        return x

    def apply(self, function, arguments):
        if function in ("symrot_sin", "symrot_cos"):
            self.near_angles.add(arguments[0])
        return self.random(function.removeprefix("symrot_").replace("fabs", "Abs"), *arguments)

    # A mean of x and y, with a random weight for each a and b. With overwhelming probability, expressions with equal
    # values here have equal values whatever functions their names stand for.
    def choose(self, comparison, a, b, x, y):
        share = self.random(comparison, a, b)
        return self.short(x() * share + y() * (1 - share))


@cache
def sine(x):
    """Return the sine of a Decimal, by 60 terms of its Taylor series, the highest powers first."""
    pi = Decimal(PI.numerator) / PI.denominator
    x = x % (2 * pi)
    square, total = x * x, 1
    for k in range(118, 0, -2):
        total = 1 - total * square / (k * (k + 1))
    return x * total


def cosine(x):
    """Return the cosine of a Decimal, as the sine of x + pi/2."""
    return sine(x + Decimal(PI.numerator) / PI.denominator / 2)


def arc_tangent(y, x):
    """Return atan2(y, x) of Decimals: the value in double precision, improved by two steps that triple its digits."""
    angle = Decimal(math.atan2(y, x))
    for _ in range(2):
        angle += (y * cosine(angle) - x * sine(angle)) / (x * x + y * y).sqrt()
    return angle


EXACT_FUNCTIONS = {"sin": sine, "cos": cosine, "sqrt": Decimal.sqrt, "Abs": abs, "atan2": arc_tangent}
EXACT_FUNCTIONS |= {"copysign": Decimal.copy_sign}


class Decimals(Arithmetic):
    """An arithmetic of 190-digit numbers with sin, cos, sqrt, abs, atan2 and copysign.

    Any other function, such as tan, has a random value, the same for equal arguments, since no law depends on it.
    """

    def __init__(self):
        super().__init__()
        self.scale = 2 ** randbelow(11)  # so that points near 0 and far from it are drawn

    def draw(self):
        return self.scale * Decimal(randbelow(2**99) - 2**98) / 2**98

    def number(self, number):
        return Decimal(number.numerator) / number.denominator

    def power(self, x, exponent):
        return x**exponent if isinstance(exponent, int) else x.sqrt() ** int(2 * exponent)

    # formulas beside a law may contain other functions
    def apply(self, function, arguments):
        if function in EXACT_FUNCTIONS:
            return EXACT_FUNCTIONS[function](*arguments)
        return self.random(function, *arguments)


class Machine(Arithmetic):
    """The arithmetic of C: each operation and each function value is rounded to the nearest double or float."""

    def __init__(self, nearest):
        super().__init__()
        self.nearest = nearest

    def literal(self, number):
        return number

    def operate(self, operation, x, y):
        return self.rounded(OPERATIONS[operation], x, y)

    def apply(self, function, arguments):
        return self.rounded(getattr(math, function.removeprefix("symrot_")), *arguments)

    def rounded(self, function, *arguments):
        try:
            return self.nearest(function(*arguments)).value
        except (ArithmeticError, ValueError):  # Python raises where C goes on with NaN or an infinity
            return math.nan


class Names(dict):
    """A dictionary of the values of symbols; a symbol without a value gets a random value at its first look-up."""

    def __init__(self, numbers):
        super().__init__(pi=numbers.number(PI))
        self.numbers = numbers

    def __missing__(self, name):
        self[name] = value = self.numbers.draw()
        return value

    def define(self, name, value):
        need(name not in self, f"{name} is already in use: expected a name that nothing above it uses")
        self[name] = value


def at_a_point(compute):
    """Return the value of ``compute()``, which draws a random point.

    If the point is unsuitable (division by zero), ``compute`` is called again; ValueError is raised after 200 calls.
    """
    for _ in range(200):
        try:
            return compute()
        except ArithmeticError:
            continue
    raise ValueError("expected formulas that are defined somewhere, but they are undefined at 200 random points")


# --- tokens and expressions as text -----------------------------------------------------------------------------------

TOKEN = re.compile(
    r"(?P<space>[ \n]+)|(?P<name>[A-Za-z_]\w*)|(?P<number>\.?\d(?:[eE][-+]|[\w.])*)"
    r"|(?P<symbol>\*\*|\+\+|--|[-+*/<>=!]=|<<|>>|->|[-+*/()\[\]{},;<>=?:])",
    re.ASCII,
)
NUMBER = re.compile(r"\d{1,400}(\.\d{1,400})?(e[-+]?\d\d?)?", re.ASCII)  # of a formula
C_NUMBER = re.compile(r"(\d{1,40}\.\d{0,40}|\d{1,40}(?=e))(e[-+]?\d\d?)?(f?)", re.ASCII)
INDEX = re.compile(r"0|[1-9]\d{0,2}", re.ASCII)
END = "the end"


class Token(NamedTuple):
    """A word of a text, with its kind (name, number or symbol) and its line."""

    kind: str
    text: str
    line: int


def tokens(text, place):
    """Return the words (tokens) of a text, each as long as possible, as in C; ``place`` names the text in messages."""
    words, start, line = [], 0, 1
    while start < len(text):
        match = TOKEN.match(text, start)
        need(match, f"{place}, line {line}: expected names, numbers and operators, got {quoted(text[start])}")
        if match.lastgroup != "space":
            words.append(Token(match.lastgroup, match[0], line))
        line += match[0].count("\n")
        start = match.end()
    return [*words, Token("end", END, line)]


class Reader:
    """A recursive-descent parser of expressions; subclasses define numbers, names and functions."""

    def __init__(self, text, place):
        self.place = place
        self.tokens = tokens(text, place)
        self.position = 0
        self.weight = 0  # number of words read, including the words of a function at each of its calls

    @property
    def token(self):
        return self.tokens[self.position]

    def here(self):
        return f"{self.place}, line {self.token.line}"

    def refuse(self, expectation):
        """Raise ValueError with the line number, the text ``expectation`` and the next word."""
        raise ValueError(f"{self.here()}: expected {expectation}, got {quoted(self.token.text)}")

    def need(self, holds, sentence):
        need(holds, f"{self.here()}: {sentence}")

    def advance(self):
        """Return the next word and move past it."""
        token = self.token
        self.position += token.kind != "end"
        self.weight += 1
        return token.text

    def accept(self, text):
        """Move past the next word and return true if it is ``text``; otherwise return false."""
        if self.token.text != text or self.token.kind == "end":
            return False
        self.advance()
        return True

    def take(self, phrase):
        """Move past the words of a phrase; raise ValueError if the next words are others."""
        for word in tokens(phrase, phrase)[:-1]:
            if not self.accept(word.text):
                self.refuse(f"`{word.text}` of `{phrase}`")

    def take_name(self, what):
        """Return the next word, which must be a name; ``what`` says in messages which name is expected.

        Names of macros and names with a leading underscore are refused.
        """
        if self.token.kind != "name" or self.token.text.startswith(("_", "SYMROT_")):
            self.refuse(what)
        return self.advance()

    def expression(self):
        """Read a sum, or a C conditional such as ``a < b ? x : y``; return its node. Conditionals are not nested."""
        a = self.sum()
        if self.token.text not in COMPARISONS:
            return a
        comparison, b = self.advance(), self.sum()
        self.take("?")
        x = self.sum()
        self.take(":")
        return Choice(comparison, a, b, x, self.sum())

    def sum(self):
        return self.chain(("+", "-"), self.product)

    def product(self):
        return self.chain(("*", "/"), self.factor)

    def chain(self, operations, operand):
        first, rest = operand(), []
        while self.token.text in operations:
            rest.append((self.advance(), operand()))
        return Chain(first, rest) if rest else first

    def factor(self):
        """Read a factor, such as ``2``, ``x``, ``sin(x)``, ``(a + b)`` or, in a formula, ``x**2``; return its node."""
        if self.accept("-"):
            return Negative(self.factor())
        if self.token.kind == "number":
            return self.power(self.number())
        if self.accept("("):
            inner = self.sum()
            self.take(")")
            return self.power(inner)
        name = self.take_name("a number, a name or a parenthesis")
        return self.power(self.call(name) if self.accept("(") else self.variable(name))

    def power(self, operand):
        return operand

    def call(self, name):
        """Read the arguments of a function call after the opening parenthesis; return the node of the call."""
        arguments = [self.sum()]
        while self.accept(","):
            arguments.append(self.sum())
        self.take(")")
        own = self.own.get(name)
        arity = len(own.parameters) if own else 4 if name in self.choices else self.functions.get(name)
        self.need(arity, f"expected a known function, got {quoted(name)}")
        self.need(len(arguments) == arity, f"expected {arity} arguments of {name}, got {len(arguments)}")
        if own:
            self.weight += own.weight
            self.check_weight()
            return OwnCall(own, arguments)
        return Choice(self.choices[name], *arguments) if name in self.choices else Call(self.base(name), arguments)

    def check_weight(self):
        self.need(
            self.weight <= LONGEST_TEXT,
            f"expected at most {LONGEST_TEXT} words, including those of called functions, got more",
        )


class FormulaReader(Reader):
    """A parser of the formulas in a certificate: symbols, powers, and functions that the certificate defines."""

    # with ``symbols``, other names are refused; in a constant, functions are refused too
    def __init__(self, text, place, own, symbols=None, is_constant=False):
        super().__init__(text, place)
        self.own, self.symbols = own, symbols
        self.functions = {} if is_constant else FORMULA_FUNCTIONS
        self.choices = {} if is_constant else FORMULA_CHOICES

    def number(self):
        text = self.advance()
        self.need(NUMBER.fullmatch(text), f"expected a number such as 2 or 0.5, got {quoted(text)}")
        return Number(Fraction(text))

    def variable(self, name):
        reserved = name in self.functions or name in self.choices or name in self.own
        known = not reserved and (self.symbols is None or name in self.symbols)
        self.need(known, f"expected the name of a variable, got {quoted(name)}")
        return Variable(name)

    def base(self, name):
        return name

    def power(self, operand):
        """Read the exponent of a power, if there is one; return the node of the power, or ``operand``."""
        if not self.accept("**"):
            return operand
        # one or two digits, or half of such a number; a negative or half exponent needs parentheses
        inner, sign = self.accept("("), -1 if self.accept("-") else 1
        self.need(
            re.fullmatch(r"\d\d?", self.token.text),
            f"expected an exponent of one or two digits, got {quoted(self.token.text)}",
        )
        exponent = sign * int(self.advance())
        if inner and self.accept("/"):
            self.take("2")
            exponent = Fraction(exponent, 2)
        if inner:
            self.take(")")
        if self.token.text == "**":
            self.refuse("one exponent")
        return Power(operand, exponent)

    def whole(self):
        """Parse the whole text as one expression and return its node; refuse any word after the expression."""
        expression = self.expression()
        self.need(self.token.kind == "end", f"expected the end of the formula, got {quoted(self.token.text)}")
        self.check_weight()
        return expression


def constant(text, place):
    """Return the number for which a text without variables stands, such as ``"1/3"`` or ``"pi/3"``, as a Fraction.

    Pi is a rational approximation. ``place`` names the text in error messages.
    """
    # PI has more digits than any number in the C text
    return FormulaReader(text, place, {}, ("pi",), is_constant=True).whole().value(AnyFunctions(), {"pi": PI})


# --- the C text -------------------------------------------------------------------------------------------------------

INDEPENDENT = "SYMROT_INDEPENDENT"
EACH_SAMPLE = "for (size_t k = 0; k < n; ++k) {"
SPANS = (
    "for (size_t start = 0; start < n; start += SYMROT_SPAN) {"
    " const size_t end = n - start < SYMROT_SPAN ? n : start + SYMROT_SPAN;"
)
BLOCKS = SPANS.replace("SYMROT_SPAN", "SYMROT_BLOCK")
OF_SPAN = "for (size_t k = start; k < end; ++k) {"
AGAIN = "const size_t again = beyond == 0 ? start : end; for (size_t k = start; k < again; ++k) {"
RESERVED = {"n", "k", "start", "end", "again", "beyond", "symrot_far", "symrot_farf", "size_t", "uint64_t", "uint32_t"}
RESERVED |= {"double", "float", "void", "const", "static", "inline", "return", "for"}
REALS = {"double": "", "float": "f"}  # type -> end of the names of its functions
COUNTERS = {"double": "uint64_t", "float": "uint32_t"}


class Parameter(NamedTuple):
    """A parameter of a C function.

    Its form is "value" (a number), "array" (the components of one sample) or "samples" (the components of all samples).
    """

    name: str
    form: str
    size: int  # components
    is_input: bool


class Body(NamedTuple):
    """The statements that a C function, or one of its loops, performs for one sample, in order."""

    statements: list  # of (name or (array, component), expression)
    far: list  # arguments of `symrot_far`, the angles that are tested for their range


class Kernel(NamedTuple):
    """A C function that writes arrays: its parameters, and its statements."""

    parameters: list
    # "each sample" has one loop over all samples; "spans" and "blocks" have two loops over a run of samples
    shape: str  # "one sample", "each sample", "spans" or "blocks"
    # a list of statements for one sample, or for each loop
    bodies: list
    real: str
    prototype: tuple  # the words of its declaration


def without_comments(text, file):
    """Return a C text in which spaces replace comments; lines keep their numbers."""
    # refused: what compilers or versions of C may read in different ways, such as trigraphs and joined lines
    odd = re.search(r"[^\n -~]|\\|\?\?|//", text)
    need(not odd, f"{file}: expected plain ASCII without backslashes, ?? and //, got {quoted(odd and odd[0])}")
    pieces, start = [], 0
    while (opened := text.find("/*", start)) >= 0:
        closed = text.find("*/", opened + 2)
        comment = text[opened + 2 : closed]
        need(closed >= 0 and "/*" not in comment, f"{file}: expected comments that end, without another comment inside")
        pieces += [text[start:opened], " ", "\n" * comment.count("\n")]
        start = closed + 2
    return "".join([*pieces, text[start:]])


def split_includes(text, name, files):
    """Return the headers that a C text includes, and the text with its #include lines replaced by empty lines."""
    known = {'#include "symrot_math.h"'} if "symrot_math.h" in files else set()
    known |= {"#include <math.h>", f'#include "{name}.h"'}
    lines, included = text.split("\n"), set()
    for number, line in enumerate(lines):
        line = line.strip()
        # any # after the first code is refused later, as a word outside the grammar: macros cannot change the text's
        # meaning
        if line and not line.startswith("#"):
            break
        if line:
            need(
                line in known and line not in included,
                f"{name}.c, line {number + 1}: expected #include of math.h, symrot_math.h or {name}.h, each once, "
                f"got {quoted(line)}",
            )
            included.add(line)
            lines[number] = ""
    return {re.search(r'[<"](.*)[>"]', line)[1] for line in included}, "\n".join(lines)


# A C text that this grammar does not describe is refused. ``real`` is double or float; E is an expression.
#
#     file        = {include} {function}
#     include     = #include <math.h> | #include "symrot_math.h" | #include "NAME.h"       (each at most once)
#     function    = static inline real name(real a, ..) { {local} return E; }
#                 | void name(parameters) { {unused} {statement} }                         (one sample)
#                 | void name(size_t n, parameters) { {unused} loops }                     (n samples)
#     parameter   = real a | [const] real a[3] | [const] real *SYMROT_RESTRICT a
#     unused      = (void)a;
#     statement   = local | assignment | far
#     local       = const real x = E;
#     assignment  = a[index] = E;
#     far         = beyond += symrot_far(E) {+ symrot_far(E)};                             (in blocks only)
#     index       = 2 (one sample) | k | n + k | 2*n + k                                   (component 2 of sample k)
#     loops       = the three phrases EACH_SAMPLE, SPANS and BLOCKS, around {statement}
#     E           = sum | sum < sum ? sum : sum                                            (or >=, ==)
#     sum         = product {(+ | -) product}
#     product     = factor {(* | /) factor}
#     factor      = -factor | number | x | a[index] | function(sum, ..) | (sum)
#
# Each name is declared once, before its use, and each component is assigned once. Formulas of certificates have the
# same expressions, and powers such as ``x**2`` and ``x**(3/2)``; their numbers are whole numbers or decimals.
class CReader(Reader):
    """A parser of the functions of a C file; the comment above this class states the grammar."""

    def __init__(self, text, name, files, sizes):
        included, text = split_includes(without_comments(text, f"{name}.c"), name, files)
        super().__init__(text, f"{name}.c")
        self.included = included
        self.sizes = sizes  # of arrays, by the certificate: a batch does not declare them
        self.kernels, self.inline = {}, {real: {} for real in REALS}
        self.parameters, self.names, self.assigned = {}, set(), set()
        self.real, self.in_batch = "double", False
        while self.token.kind != "end":
            self.function()

    # expressions

    def number(self):
        text = self.advance()
        match = C_NUMBER.fullmatch(text)
        self.need(
            match and match[3] == REALS[self.real],
            f"expected a {self.real} such as 2.0{REALS[self.real]}, got {quoted(text)}",
        )
        return Literal(NEAREST[self.real](float(text.removesuffix("f"))).value)

    def variable(self, name):
        """Return the node for a local variable, a parameter that is a number, or a component of an input array."""
        if self.token.text == "[":
            return Variable(self.component(name, is_input=True))
        if name not in self.names:
            self.position -= 1
            self.refuse("a variable that is declared above")
        return Variable(name)

    def component(self, name, is_input):
        """Read an array index; return (array, component), such as ("q", 2) for ``[2]`` or for ``[2*n + k]``."""
        parameter = self.parameters.get(name)
        self.need(
            parameter and parameter.form != "value" and parameter.is_input == is_input,
            f"expected an array of {'inputs' if is_input else 'outputs'}, got {quoted(name)}",
        )
        self.take("[")
        component = 0
        if parameter.form == "array":
            component = self.index()
        # sample k of n: [k] is component 0, [n + k] component 1, [2*n + k] component 2
        elif not self.accept("k"):
            component = 1
            if self.token.text != "n":
                component = self.index()
                self.take("*")
            self.take("n + k")
        self.need(component < parameter.size, f"expected an index of {name} below {parameter.size}, got {component}")
        self.take("]")
        return name, component

    def index(self):
        if not INDEX.fullmatch(self.token.text):
            self.refuse("a whole number")
        return int(self.advance())

    def use(self, real):
        """Prepare to read a function whose numbers have the C type ``real``: "double" or "float"."""
        self.real, end = real, REALS[real]
        # the functions that such a text may call: its own, those of <math.h> and symrot_math.h if they are included
        self.own = self.inline[real]
        functions = C_FUNCTIONS if "math.h" in self.included else {}
        if "symrot_math.h" in self.included:
            functions = functions | VECTOR_FUNCTIONS
        choices = VECTOR_CHOICES if "symrot_math.h" in self.included else {}
        self.functions = {name + end: arity for name, arity in functions.items()}
        self.choices = {name + end: comparison for name, comparison in choices.items()}

    def base(self, name):
        return name.removesuffix("f") if self.real == "float" else name

    # functions

    def new_name(self, what):
        """Return the next word, which must be a name that is not in use so far, in this text or in C.

        ``what`` says in messages which name is expected.
        """
        name = self.take_name(what)
        known = [self.names, self.parameters, self.kernels, RESERVED, *self.inline.values()]
        for end in REALS.values():
            known.append({f + end for f in (*C_FUNCTIONS, *VECTOR_FUNCTIONS, *VECTOR_CHOICES)})
        self.need(
            not any(name in each for each in known),
            f"{name} is already in use: expected {what} that has no meaning yet",
        )
        return name

    def function(self):
        self.parameters, self.names, self.weight = {}, set(), 0
        if self.token.text == "static":
            self.inline_function()
        else:
            self.kernel()
        self.check_weight()

    def inline_function(self):
        """Read and store a helper function (local variables, then its value); it may call only functions above it."""
        self.take("static inline")
        if self.token.text not in REALS:
            self.refuse("double or float")
        self.use(self.advance())
        name = self.new_name("the name of a function")
        if not name.startswith("symrot_"):
            self.position -= 1
            self.refuse("the name of a function that begins with symrot_")
        self.take("(")
        parameters = []
        while not parameters or self.accept(","):
            self.take(self.real)
            parameters.append(self.new_name("the name of a parameter"))
            self.names.add(parameters[-1])
        self.take(") {")
        local = []
        while self.token.text == "const":
            local.append(self.local())
        self.take("return")
        result = self.expression()
        self.take("; }")
        self.inline[self.real][name] = Definition(parameters, local, result, self.weight)

    def kernel(self):
        """Read and store a function that writes arrays, for n samples if n is its first parameter, else for one."""
        start = self.position
        self.take("void")
        name = self.new_name("the name of a function")
        self.take("(")
        self.in_batch = self.accept("size_t")
        if self.in_batch:
            self.take("n ,")
        first = [token.text for token in self.tokens[self.position : self.position + 2]]  # const float, or float
        self.use("float" if "float" in first else "double")
        while not self.parameters or self.accept(","):
            parameter = self.parameter()
            self.parameters[parameter.name] = parameter
            if parameter.form == "value":
                self.names.add(parameter.name)
        self.take(")")
        prototype = tuple(token.text for token in self.tokens[start : self.position])
        self.take("{")
        while self.accept("("):  # (void)a; an input that is not needed
            self.take("void )")
            self.need(self.take_name("a parameter") in self.parameters, "expected a parameter behind (void)")
            self.take(";")
        shape, bodies = self.loops() if self.in_batch else ("one sample", [self.body()])
        self.kernels[name] = Kernel([*self.parameters.values()], shape, bodies, self.real, prototype)

    def parameter(self):
        is_input = self.accept("const")
        self.take(self.real)
        samples = self.accept("*")
        if samples:
            self.take("SYMROT_RESTRICT")
        name = self.new_name("the name of a parameter")
        if samples:
            return Parameter(name, "samples", self.sizes.get(name, 0), is_input)
        if self.accept("["):
            size = self.index()
            self.take("]")
            return Parameter(name, "array", size, is_input)
        self.need(not is_input, f"expected `{self.real} {name}` without const, as C passes a number by value")
        return Parameter(name, "value", 1, True)

    def loops(self):
        """Read the loops over samples; return a pair (form, list of the loops' bodies).

        The form is "each sample" (one loop over all samples), "spans" (for each run of samples two loops, each for
        some outputs) or "blocks" (for each run a loop with fast sine and cosine, and one that repeats it with <math.h>
        if an angle is too large).
        """
        if self.accept(INDEPENDENT):
            self.take(EACH_SAMPLE)
            bodies = [self.body()]
            self.take("}")
            return "each sample", bodies
        # Each form visits every sample from 0 to n - 1. Two loops over a span compute different outputs, so that arrays
        # stay in the processor's cache. A block is computed with functions for a limited range of angles, and again
        # with <math.h> if ``beyond``, the number of angles outside that range, is not zero.
        shape = "blocks" if self.comes(BLOCKS) else "spans"
        self.take(BLOCKS if shape == "blocks" else SPANS)
        if shape == "blocks":
            self.take(f"{COUNTERS[self.real]} beyond = 0;")
        self.take(f"{INDEPENDENT} {OF_SPAN}")
        bodies = [self.body(tests_angles=shape == "blocks")]
        self.take(AGAIN if shape == "blocks" else f"{INDEPENDENT} {OF_SPAN}")
        bodies.append(self.body())
        self.take("} }")
        return shape, bodies

    def comes(self, phrase):
        """Return whether the next words are ``phrase``; do not move past them."""
        words = [token.text for token in tokens(phrase, phrase)[:-1]]
        return words == [token.text for token in self.tokens[self.position : self.position + len(words)]]

    def body(self, tests_angles=False):
        """Read statements up to a closing brace, where the scope of their variables ends; return a Body.

        With ``tests_angles``, one statement may test whether angles are too large for symrot_sin and symrot_cos.
        """
        outer, self.names, self.assigned = self.names, set(self.names), set()
        statements, far = [], []
        while not self.accept("}"):
            if self.token.text == "const":
                statements.append(self.local())
            # beyond += symrot_far(a) + ..; counts the angles that are too large for symrot_sin and symrot_cos
            elif tests_angles and not far and self.accept("beyond"):
                far = self.far()
            else:
                statements.append(self.assignment())
        self.names = outer
        return Body(statements, far)

    def local(self):
        """Read ``const double x = E;``, where E must not use x; return (name, node of E)."""
        self.take(f"const {self.real}")
        name = self.new_name("the name of a variable")
        self.take("=")
        expression = self.expression()
        self.take(";")
        self.names.add(name)
        return name, expression

    def assignment(self):
        """Read ``a[2] = E;`` and return ((array, component), node of E); no output may be assigned twice."""
        place = self.component(self.take_name("`const`, an output or `}`"), is_input=False)
        self.need(place not in self.assigned, f"expected an output to be written once, got {place[0]} again")
        self.assigned.add(place)
        self.take("=")
        expression = self.expression()
        self.take(";")
        return place, expression

    def far(self):
        """Read the line that tests whether angles are too large for symrot_sin and symrot_cos; return these angles."""
        tested = []
        self.take("+=")
        while not tested or self.accept("+"):
            self.take(f"symrot_far{REALS[self.real]}(")
            tested.append(self.sum())
            self.take(")")
        self.take(";")
        return tested


def run(body, numbers, inputs):
    """Run the statements ``body`` of a C function on ``inputs`` in the arithmetic ``numbers``.

    Return a map from each output to its value, and the set of the angles to which the statements apply symrot_far, the
    C function that tells whether an angle is too large for symrot_sin and symrot_cos.
    """
    names, outputs = dict(inputs), {}
    for target, expression in body.statements:
        value = expression.value(numbers, names)
        (names if isinstance(target, str) else outputs)[target] = value
    return outputs, {angle.value(numbers, names) for angle in body.far}


# --- the certificate --------------------------------------------------------------------------------------------------

TEXT = str
ROW = (TEXT, TEXT, TEXT)
SHAPE = {
    "kernel": TEXT, "title": TEXT, "regenerate": TEXT, "files": {str: TEXT}, "inputs": [ROW],
    "spec": {"parameters": {str: TEXT}, "named": [(TEXT, TEXT)], "formulas": [ROW], "functions": [(TEXT, TEXT)]},
    "laws": [{"law": TEXT, "vanishing": [TEXT], "given": [TEXT]}],
    "readback": {str: {"type": TEXT, "constants": [(TEXT, TEXT)], "series": [(TEXT, TEXT, [TEXT], TEXT)]}},
}  # fmt: skip
ROUNDING_SHAPE = {
    "clearance": TEXT, "box": {str: (TEXT, TEXT)},
    "precisions": [{"precision": TEXT, "outputs": [{"output": TEXT, "absolute": TEXT}]}],
}  # fmt: skip


def check_shape(value, shape, place):
    """Raise ValueError if a value does not have the types in ``shape``, such as ``{"name": str, "sizes": [str]}``.

    Other entries of the value are ignored; ``place`` names the value in error messages.
    """
    if isinstance(shape, type):
        need(isinstance(value, shape), f"{place}: expected a text, as the schema says, got {quoted(value)}")
    elif isinstance(shape, tuple):
        right = isinstance(value, list) and len(value) == len(shape)
        need(right, f"{place}: expected a list of {len(shape)}, as the schema says, got {quoted(value)}")
        for index, part in enumerate(shape):
            check_shape(value[index], part, f"{place}[{index}]")
    elif isinstance(shape, list):
        need(isinstance(value, list), f"{place}: expected a list, as the schema says, got {quoted(value)}")
        for index, part in enumerate(value):
            check_shape(part, shape[0], f"{place}[{index}]")
    else:
        need(isinstance(value, dict), f"{place}: expected an object, as the schema says, got {quoted(value)}")
        for key in value if str in shape else shape:
            need(key in value, f"{place}: expected {key!r}, as the schema says, but it is missing")
            check_shape(value[key], shape[str] if str in shape else shape[key], f"{place}.{quoted(key)[1:-1]}")


def content(path):
    """Return the bytes of a file; refuse a file that is not regular or is larger than LARGEST_FILE."""
    small = path.is_file() and path.stat().st_size <= LARGEST_FILE
    need(small, f"{path.name} is not a regular file of at most {LARGEST_FILE} bytes: expected a file of the kernel")
    return path.read_bytes()


def text_of(path):
    """Return the text of a file exactly, with its line ends unchanged."""
    try:
        return content(path).decode("utf-8")
    except UnicodeDecodeError:
        raise ValueError(f"{path.name}: expected text in UTF-8, got other bytes") from None


def without_repetition(pairs):
    """Return a JSON object from its (name, value) pairs; refuse a repeated name, whose value is ambiguous."""
    items = dict(pairs)
    need(len(items) == len(pairs), "expected each name once in an object of the certificate, got a name twice")
    return items


def certified(path):
    """Check a certificate's checksum (the entry ``seal``) and the hashes of its files; return the other entries."""
    try:
        data = json.loads(content(path), object_pairs_hook=without_repetition)
    except RecursionError:
        raise ValueError(f"{path.name}: expected a certificate, got lists nested too deeply") from None
    except (json.JSONDecodeError, UnicodeDecodeError) as reason:
        raise ValueError(f"{path.name}: expected JSON, but the text is not JSON ({reason})") from None
    check_shape(data, {"schema": TEXT, "seal": TEXT, "kernel": TEXT, "files": {str: TEXT}}, "certificate")
    need(
        data["schema"] == "symrot.certificate/1",
        f"the schema is {quoted(data['schema'])}: expected symrot.certificate/1, the certificate of a kernel; "
        "`symrot audit` checks the certificates of steps",
    )
    sealed = {key: value for key, value in data.items() if key != "seal"}
    text = json.dumps(sealed, sort_keys=True, separators=(",", ":"))
    seal = sha256(text.encode()).hexdigest() == data["seal"]
    need(seal, "the certificate was changed after it was sealed: expected 'seal' to be the SHA-256 of its other parts")
    name, files = data["kernel"], data["files"]
    right = re.fullmatch(r"[A-Za-z]\w*", name, re.ASCII) and path.name == f"{name}.cert.json"
    need(
        right and {f"{name}.c", f"{name}.h"} <= {*files},
        f"the certificate belongs to another file: expected the kernel of {path.name}, with its C file and header",
    )
    for file, digest in files.items():
        need(
            re.fullmatch(r"(\.\./){0,2}(\w+/)*\w+\.\w+", file, re.ASCII),
            f"{quoted(file)} is not the path of a kernel's file: expected a path such as NAME.c",
        )
        # Files in other folders (NumPy texts) may be missing. A hash shows only that a file was not changed after it
        # was certified; other checks show that it is right.
        if "/" not in file or (path.parent / file).exists():
            right = sha256(content(path.parent / file)).hexdigest() == digest
            need(right, f"{file} was changed after it was certified")
    return sealed


def is_name(text):
    """Return whether a text can be the name of a symbol in a formula: a name without another meaning."""
    reserved = text in FORMULA_FUNCTIONS or text in FORMULA_CHOICES or text == "pi"
    return bool(re.fullmatch(r"[A-Za-z]\w*", text, re.ASCII)) and not reserved


def defined_functions(definitions):
    """Return the functions that a certificate defines, as a map from name to Definition; each may call earlier ones."""
    functions = {}
    for name, text in definitions:
        new = is_name(name) and name not in functions
        need(new, f"{quoted(name)} is already in use: expected a new name for a function")
        parameters = [letter for letter in "xyzw" if re.search(rf"\b{letter}\b", text)]
        need(parameters and parameters == [*"xyzw"][: len(parameters)], f"{name}: expected a function of x, or of x, y")
        reader = FormulaReader(text, f"function {name}", functions, ("pi", *parameters))
        expression = reader.whole()
        functions[name] = Definition(parameters, [], expression, reader.weight)
    return functions


class Specification:
    """The formulas of a certificate as expression trees.

    The formulas may call ``functions``, a map from name to Definition: functions that the certificate itself defines,
    such as sinc.
    """

    def __init__(self, data, functions):
        spec = data["spec"]
        self.functions = functions
        self.symbols = {place: symbol for place, symbol, _ in data["inputs"]}
        symbols = [symbol for _, symbol, _ in data["inputs"]]
        places = [place for place, *_ in data["inputs"] + spec["formulas"]]
        need(
            all(is_name(symbol) and symbol not in functions for symbol in symbols)
            and len({*symbols}) == len(symbols)
            and len({*places}) == len(places),
            "an input has no valid name, or two inputs have the same: expected a different name for each",
        )
        slots = {symbol for place, symbol, _ in data["inputs"] + spec["formulas"] if place.startswith("p[")}
        need(slots == {*spec["parameters"]}, "the parameters differ from the inputs p[0], p[1], ..: expected the same")
        self.inputs = []  # of (place, expression): a symbol, or a parameter by its formula
        for place, symbol in self.symbols.items():
            text = spec["parameters"].get(symbol, symbol)
            self.inputs.append((place, self.read(text, f"input {quoted(place)}")))
        self.named = []  # of (symbol, expression): parts of formulas, then outputs
        for symbol, text in spec["named"]:
            self.named.append((symbol, self.read(text, f"formula of {quoted(symbol)}")))
        self.outputs = []  # of (place, symbol)
        for place, symbol, text in spec["formulas"]:
            self.named.append((symbol, self.read(text, f"formula of {quoted(place)}")))
            self.outputs.append((place, symbol))

    def read(self, text, place):
        return FormulaReader(text, place, self.functions).whole()

    def set_values(self, names):
        """Add the value of each formula to ``names``; return the values of the C inputs, such as q[2]."""
        # ``names`` maps symbols to values, and draws a random value for a symbol without one
        inputs = {place: expression.value(names.numbers, names) for place, expression in self.inputs}
        for symbol, expression in self.named:
            names.define(symbol, expression.value(names.numbers, names))
        return inputs


# --- laws -------------------------------------------------------------------------------------------------------------


def draw_hypothesis(members, names):
    """Assign random values in ``names`` to the symbols ``members``: the entries of a rotation matrix or unit vector.

    Nine symbols get the entries of a matrix, row by row; another number of symbols gets the components of a vector.
    """
    # 2*v*v^T + 2*q0*[v]x + (2*q0^2 - 1)*1 for the unit quaternion (q0, v)
    vector = [names.numbers.draw() for _ in range(4 if len(members) == 9 else len(members))]
    length = Decimal.sqrt(sum(each * each for each in vector))
    vector = [each / length for each in vector]
    if len(members) == 9:
        q0, q1, q2, q3 = vector
        a = 2 * q0 * q0 - 1
        vector = [
            2 * q1 * q1 + a, 2 * (q1 * q2 - q0 * q3), 2 * (q1 * q3 + q0 * q2),
            2 * (q2 * q1 + q0 * q3), 2 * q2 * q2 + a, 2 * (q2 * q3 - q0 * q1),
            2 * (q3 * q1 - q0 * q2), 2 * (q3 * q2 + q0 * q1), 2 * q3 * q3 + a,
        ]  # fmt: skip
    for name, value in zip(members, vector, strict=True):
        names.define(name, value)


def check_law(law, specification, points):
    """Raise ValueError if an expression of a law, which must be zero, is not zero to 60 digits at random points."""
    place = f"the law {quoted(law['law'])}"
    need(law["vanishing"], f"{place} does not follow: expected at least one expression that must be zero, got none")
    members = law["given"]
    need(
        all(is_name(name) for name in members),
        f"{place}: expected a list of names of symbols as 'given', got {quoted(members)}",
    )
    expressions = [specification.read(text, place) for text in law["vanishing"]]

    def values(law_holds):
        names = Names(Decimals())
        if law_holds:
            if members:
                draw_hypothesis(members, names)
            specification.set_values(names)
        return [expression.value(names.numbers, names) for expression in expressions]

    for _ in range(points):
        rests, sizes = at_a_point(lambda: values(True)), at_a_point(lambda: values(False))
        for rest, size in zip(rests, sizes, strict=True):
            # An analytic expression that is not identically zero passes at a random point with negligible probability.
            # ``size`` is its value if all symbols are random and unrelated.
            small = min(max(abs(size) / 10**60, Decimal("1e-70")), Decimal("1e-40"))
            need(
                abs(rest) <= small,
                f"{place} does not follow from the formulas: expected 0 at a random point, computed with 60 digits, "
                f"got {rest:.3}",
            )


# --- series and constants ---------------------------------------------------------------------------------------------

NEAREST = {"double": c_double, "float": c_float}
PRECISIONS = {"double": "binary64", "float": "binary32"}
LEAST = {"double": Fraction(1, 2**55), "float": Fraction(1, 2**26)}  # a quarter of a unit in the last place


def check_series(series, functions, real):
    """Check the polynomial that replaces a function near x = 0, for numbers of the C type ``real``.

    Return ``functions`` with one more function, which computes the polynomial near x = 0.
    """
    name, split_text, coefficient_texts, rest_text = series
    place = f"series of {quoted(name)}"
    split, rest = constant(split_text, place), constant(rest_text, place)
    coefficients = [constant(text, place) for text in coefficient_texts]
    need(
        name in functions and functions[name].parameters == ["x"] and 0 < split <= 100 and len(coefficients) < 50,
        f"{place}: expected a function of x that the certificate defines, a split and coefficients",
    )
    powers = [Chain(Number(c), [("*", Power(Variable("x"), 2 * k))]) for k, c in enumerate(coefficients)]
    polynomial = Chain(Number(Fraction(0)), [("+", each) for each in powers])
    exact = functions[name]

    def left_out():
        numbers = Decimals()
        x = numbers.number(split).sqrt() * (randbelow(2**65) - 2**64) / 2**64  # of either sign
        return abs(polynomial.value(numbers, {"x": x}) / exact.call(numbers, [x]) - 1)

    # what the certificate states, and at most a quarter of a unit in the last place
    largest = min(rest, LEAST[real])
    for _ in range(64):
        error = at_a_point(left_out)
        need(error <= largest, f"{place}: expected an error of at most {float(largest):.3}, got {error:.3}")
    square = Chain(Variable("x"), [("*", Variable("x"))])
    choice = Choice("<", square, Number(split), polynomial, exact.result)
    return functions | {name: exact._replace(result=choice)}


def constants_of(readback, real):
    """Return a map from each rounded constant of the C text to its exact number."""
    pairs = [(constant(a, "constants"), constant(b, "constants")) for a, b in readback["constants"]]
    for name, _, coefficients, _ in readback["series"]:
        numbers = [abs(constant(text, f"series of {quoted(name)}")) for text in coefficients]
        pairs += zip(numbers, numbers, strict=True)
    constants = {}
    for written, exact in pairs:
        number = NEAREST[real](float(written)).value
        # a multiple of 2^-20, such as 1/2, needs no rounding
        right = NEAREST[real](float(exact)).value == number and exact * 2**20 % 1
        need(right, f"a constant is wrong: expected the {real} nearest to {float(exact)!r}, got {number!r}")
        constants[number] = exact
    return constants


# --- C text = formulas ------------------------------------------------------------------------------------------------


def component_of(place):
    """Return the component that a text names: ("q", 2) for ``q[2]``, and ("t", 0) for a single number ``t``."""
    match = re.fullmatch(r"([A-Za-z]\w*)(?:\[(0|[1-9]\d{0,2})\])?", place, re.ASCII)
    need(match, f"{quoted(place)}: expected an argument of a function, such as W or q[2]")
    return match[1], int(match[2] or 0)


def array_sizes(data, is_input):
    """Return the number of components of each input or output array; refuse gaps in the component numbers."""
    sizes = {}
    for place, *_ in data["inputs"] if is_input else data["spec"]["formulas"]:
        name, component = component_of(place)
        right = component == sizes.get(name, 0) and not (place == name and name in sizes)
        need(right, f"{quoted(place)}: expected components in order, such as q[0], q[1], in the certificate")
        sizes[name] = component + 1
    return sizes


def expected_parameters(data, in_batch):
    """Return the parameters that a C function must have, according to the inputs and outputs of the certificate."""
    by_value = {place for place, *_ in data["inputs"] if "[" not in place}
    parameters = []
    for is_input in (True, False):
        for name, size in array_sizes(data, is_input).items():
            # for one sample, a number is passed by value, and any other quantity as an array
            form = "value" if is_input and name in by_value else "array"
            # all samples share the parameters of a scene
            shared = bool(data["spec"]["parameters"]) and name == "p"
            if in_batch and not shared:
                form = "samples"
            parameters.append(Parameter(name, form, size, is_input))
    return parameters


def by_component(values):
    """Return a map like ``values``, from inputs to values, with the key ("q", 2) instead of ``"q[2]"``."""
    named = {component_of(place): value for place, value in values.items()}
    # a single number "t" has two keys: ("t", 0) for its array in a batch, and "t"
    return named | {place: value for place, value in values.items() if "[" not in place}


class ExactPoint(NamedTuple):
    """A random point: the values of inputs and outputs as exact fractions, by component such as ("q", 2)."""

    # holds the random values of functions, which the C text must use too
    numbers: AnyFunctions
    inputs: dict
    outputs: dict


def exact_point(specification):
    """Return a random point at which all inputs differ, so that a C text cannot use one input in place of another.

    ValueError is raised if the certificate gives two inputs the same symbol or formula, or gives an input the value pi.
    """
    names = Names(AnyFunctions())
    inputs = specification.set_values(names)
    need(
        len({names["pi"], *inputs.values()}) == len(inputs) + 1,
        "two inputs have the same name, or one is pi: expected a different name for each",
    )
    outputs = {component_of(place): names[symbol] for place, symbol in specification.outputs}
    return ExactPoint(names.numbers, by_component(inputs), outputs)


def check_formulas(name, kernel, data, point):
    """Raise ValueError if the outputs of a C function differ from the formulas at a random, exact point."""
    need(
        kernel.parameters == expected_parameters(data, kernel.shape != "one sample"),
        f"arguments or loops of {name} differ: expected the inputs and outputs of the certificate, in their order",
    )
    # functions and conditionals are random at the point, so that equality there means equality as expressions
    numbers, expected = point.numbers, point.outputs
    computed = {}
    for body in kernel.bodies:
        numbers.near_angles.clear()
        outputs, far = run(body, numbers, point.inputs)
        need(
            numbers.near_angles <= far,
            f"{name} does not test all angles for their range: expected symrot_far of each angle in a first loop",
        )
        for place, value in outputs.items():
            right = place in expected and value == expected[place]
            need(
                right,
                f"{name} does not compute its formulas: expected {place[0]}[{place[1]}] to have the "
                "value of the certificate's formula",
            )
        # two loops over a span compute different outputs; in the other shapes each loop computes all outputs
        if kernel.shape == "spans":
            need(
                not computed.keys() & outputs.keys(),
                f"{name} does not compute its formulas: expected each output in one of the two loops only",
            )
            computed |= outputs
        else:
            computed = outputs
            need(
                computed.keys() == expected.keys(),
                f"{name} does not compute its formulas: expected all outputs in each loop",
            )
    need(computed.keys() == expected.keys(), f"{name} does not compute its formulas: expected all outputs")


# --- rounding errors --------------------------------------------------------------------------------------------------


class BoxPoint(NamedTuple):
    """A random point of the box for which rounding errors are bounded: inputs, exact outputs, and bounds of errors."""

    inputs: dict
    exact: dict
    bounds: dict


def hexadecimal(text, place):
    """Return the value, a double, of a hexadecimal text such as 0x1.8p+3; ``place`` names the text in messages."""
    try:
        return float.fromhex(text)
    except (ValueError, OverflowError):
        raise ValueError(f"{place}: expected a number such as 0x1.8p+3, got {quoted(text)}") from None


def point_of_box(data, specification, real):
    """Return a random point of the box for which rounding errors are bounded, or None if no point can be drawn.

    No point can be drawn if the certificate states no bounds, or if the kernel has constants of a scene as parameters.
    Nor can one be drawn if the bounds exclude points of the box: those at which an atan2 has arguments (y, x) of a
    length below the certificate's ``clearance``, if that is not 0.
    """
    if "rounding" not in data or data["spec"]["parameters"]:
        return None
    check_shape(data["rounding"], ROUNDING_SHAPE, "rounding")
    bounds = data["rounding"]
    if hexadecimal(bounds["clearance"], "rounding.clearance"):
        return None
    numbers = Decimals()
    names, inputs = Names(numbers), {}
    for place, symbol in specification.symbols.items():
        need(place in bounds["box"], f"rounding.box: expected a range of {quoted(place)}, but it is missing")
        low, high = (hexadecimal(end, f"rounding.box.{place}") for end in bounds["box"][place])
        need(
            -math.inf < low <= high < math.inf,
            f"rounding.box: expected a finite range of {quoted(place)}, got {low} to {high}",
        )
        value = NEAREST[real](low + (high - low) * randbelow(2**53 + 1) / 2**53).value
        inputs[place] = min(max(value, low), high)
        names.define(symbol, Decimal(inputs[place]))
    try:
        for name, expression in specification.named:
            names.define(name, expression.value(numbers, names))
    except ArithmeticError:
        raise ValueError("rounding.box: expected formulas that are defined at every point of the box") from None
    limits = {}
    for precision in bounds["precisions"]:
        if precision["precision"] == PRECISIONS[real]:
            for each in precision["outputs"]:
                limits[component_of(each["output"])] = Decimal(hexadecimal(each["absolute"], "rounding.precisions"))
    exact = {component_of(place): names[symbol] for place, symbol in specification.outputs}
    return BoxPoint(by_component(inputs), exact, limits)


def check_rounding(name, kernel, point):
    """Raise ValueError if a C function's error at a point of the box is larger than the certified bound."""
    machine = Machine(NEAREST[kernel.real])
    # computed as C computes it, rounding by rounding; a bound that fails at one point is refuted
    for body in kernel.bodies:
        outputs, _ = run(body._replace(far=[]), machine, point.inputs)
        for place in outputs.keys() & point.bounds.keys():
            value, bound = outputs[place], point.bounds[place]
            right = math.isfinite(value) and abs(Decimal(value) - point.exact[place]) <= bound
            need(
                right,
                f"{name} has a larger rounding error than its bound: expected at most {bound:.3} in "
                f"{place[0]}[{place[1]}]",
            )


def check_precision(name, data, specification, kernels):
    """Check the C functions for double or float, for one sample and for many, against formulas and error bounds."""
    readback = data["readback"][name]
    real = readback["type"]
    need(
        real in REALS and name == f"symrot_{data['kernel']}{REALS[real]}",
        f"{quoted(name)}: a function has another name or type: expected symrot_{data['kernel']} for double, or "
        f"symrot_{data['kernel']}f for float",
    )
    functions = specification.functions
    for series in readback["series"]:
        functions = check_series(series, functions, real)
    point = at_a_point(lambda: exact_point(Specification(data, functions)))
    # exact numbers replace the rounded constants, and functions the series that approximate them
    point.numbers.constants |= constants_of(readback, real)
    box_point = point_of_box(data, specification, real)
    for function, shapes in ((name, {"one sample"}), (f"{name}_batch", {"each sample", "spans", "blocks"})):
        kernel = kernels[function]
        need(
            kernel.real == real and kernel.shape in shapes,
            f"{function}: expected a function of {real} numbers for "
            f"{'one sample' if function == name else 'many samples'}",
        )
        check_formulas(function, kernel, data, point)
        if box_point:
            check_rounding(function, kernel, box_point)


# --- header and names -------------------------------------------------------------------------------------------------

HEADER_TOP = """#ifndef SYMROT_@_H
#define SYMROT_@_H
#include <stddef.h>
#ifndef SYMROT_RESTRICT
#ifdef __cplusplus
#define SYMROT_RESTRICT __restrict
#else
#define SYMROT_RESTRICT restrict
#endif
#endif
#ifndef SYMROT_INDEPENDENT
#if defined(__clang__) && defined(__NO_MATH_ERRNO__)
#define SYMROT_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__) && !defined(__clang__)
#define SYMROT_INDEPENDENT _Pragma("GCC ivdep")
#else
#define SYMROT_INDEPENDENT
#endif
#endif"""
HEADER_SPAN = """#ifndef SYMROT_SPAN
#define SYMROT_SPAN 2048
#endif"""
HEADER_OPEN = """#ifdef __cplusplus
extern "C" {
#endif"""
HEADER_END = """#ifdef __cplusplus
}
#endif
#endif"""


def check_header(name, text, kernels):
    """Raise ValueError if a header contains more than the known macros and the prototypes of the C file."""
    # the C file includes the header, so another macro there could change the meaning of the C text
    text = without_comments(text, f"{name}.h holds text that C compilers may read in different ways")
    lines = [line.strip() for line in text.split("\n") if line.strip()]
    refusal = f"{name}.h holds more than prototypes: expected the macros of symrot and a prototype of each function"
    top = HEADER_TOP.replace("@", name.upper()).split("\n")
    for part in (top, HEADER_SPAN.split("\n"), HEADER_OPEN.split("\n")):
        if lines[: len(part)] == part:
            lines = lines[len(part) :]
        else:
            need(part[0] == "#ifndef SYMROT_SPAN", refusal)  # only kernels with spans have this macro
    end = HEADER_END.split("\n")
    need(lines[-len(end) :] == end, refusal)
    words = [token.text for token in tokens("\n".join(lines[: -len(end)]), refusal)[:-1]]
    expected = sorted([*kernel.prototype, ";"] for kernel in kernels.values())
    declared = [[]]
    for word in words:
        declared[-1].append(word)
        if word == ";":
            declared.append([])
    need(declared.pop() == [] and sorted(declared) == expected, refusal)


def check_banner(data, text):
    """Raise ValueError if a C file's first comment (banner) lacks the name, title or command in the certificate."""

    # Only letters and digits are compared: banners break lines, omit characters that would end a comment, and write
    # other alphabets as codes such as <U+00E9>. A renamed kernel is revealed if any file still has the old name.
    def bare(words):
        return re.sub(r"<U\+[0-9A-F]{4,6}>|[^A-Za-z0-9]", "", "".join(words.split()))

    name = data["kernel"]
    banner = text[: max(text.find("*/"), 0)].replace("\n *", "\n")
    title = banner.split("\n\n")[0]
    need(
        bare(title) == bare(f"{name}: {data['title']}"),
        f"{name}.c: expected the comment at the top to begin with the kernel and title of the certificate, got "
        f"{quoted(title)}",
    )
    command = bare(data["regenerate"])
    need(
        command and command in bare(banner),
        f"{name}.c: expected the comment at the top to name the command in the certificate's 'regenerate'",
    )


def has_choices(data):
    """Return whether formulas or laws contain conditionals, Abs or copysign; a point tests only one branch of each."""
    return bool(re.search(r"select_|Abs|copysign|\?", json.dumps([data["spec"], data["laws"]])))


def check_files(path):
    """Run all checks on a certificate and its files; return one line that lists the checks."""
    data = certified(path)
    check_shape(data, SHAPE, "certificate")
    name, files, readback = data["kernel"], data["files"], data["readback"]
    need(
        files.get("symrot_math.h", MATH_HEADER_SHA256) == MATH_HEADER_SHA256,
        "symrot_math.h was changed: expected the text that symrot emits",
    )
    need(data["laws"], "there are no laws: expected at least one")
    text, header = text_of(path.with_name(f"{name}.c")), text_of(path.with_name(f"{name}.h"))
    check_banner(data, text)
    sizes = {array: size for is_input in (True, False) for array, size in array_sizes(data, is_input).items()}
    kernels = CReader(text, name, files, sizes).kernels
    expected = {function + end for function in readback for end in ("", "_batch")}
    need(
        readback and kernels.keys() == expected,
        f"the functions differ: expected {', '.join(sorted(expected))} in {name}.c",
    )
    check_header(name, header, kernels)
    specification = Specification(data, defined_functions(data["spec"]["functions"]))
    with localcontext(DIGITS):
        for law in data["laws"]:
            check_law(law, specification, 64 if has_choices(data) else 8)
        for function in readback:
            check_precision(function, data, specification, kernels)
    return (
        f"{name}: {len(files)} hashes agree; the C text of {' and '.join(readback)}, and of their batch functions, "
        "agrees with the formulas; the laws hold"
    )


def check(path):
    """Check a certificate; return one line that lists the checks, or raise an error whose message is one sentence."""
    try:
        return check_files(path)
    except (ValueError, OSError):
        raise
    except RecursionError:
        raise ValueError("expected fewer nested parentheses and calls, got too many") from None
    except (ArithmeticError, MemoryError) as reason:
        raise ValueError(f"expected numbers within the range of a double, got others ({reason!r})") from None


def main(paths):
    """Check certificates one after the other; print a line for each, and exit with code 1 at the first that fails."""
    if not paths:
        sys.exit("usage: python recheck.py NAME.cert.json ..")
    for path in paths:
        try:
            print(check(Path(path)))
        except (ValueError, OSError) as reason:
            sys.exit(f"{path}: {reason}")


if __name__ == "__main__":
    main(sys.argv[1:])
