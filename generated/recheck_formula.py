"""What formulas of certificates and of C mean, for recheck.py and recheck_c.py: standard library, nothing of symrot."""

# mypy: ignore-errors
import ast
import math
import operator
import re
from decimal import Decimal
from fractions import Fraction
from functools import cache
from itertools import product

CHOICE = re.compile(r"([^?:<>=]+) (<|>=|==) ([^?:<>=]+) \? ([^?:<>=]+) : ([^?:<>=]+)")
ATOM = re.compile(r"(?<![\w.])(\w+\[[^]]*\]|\d[\w.]*(?:(?<=e)[-+]\w+)?)")
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}
SAFE = {  # functions that are none of <math.h>
    "sinc": "x == 0 ? 1 : sin(x)/x",
    "arc_ratio": "x == 0 ? 1/y : atan2(x, y)/x",
    "sine_gap": "(x - sin(x))/x**3",
    "tangent_gap": "(sin(x) - x*cos(x))/x**3",
    "select_ge": "x >= y ? z : w",
    "select_lt": "x < y ? z : w",
    "select_eq": "x == y ? z : w",
    "Abs": "fabs(x)",
}
TAYLOR = {"sine_gap": lambda k: 1, "tangent_gap": lambda k: 2 * k + 2}  # times (-1)^k x^(2 k)/(2 k + 3)!
PI = "3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803482534211707"


def need(holds, said):
    if not holds:
        raise ValueError(said)


@cache
def parsed(text):
    """Return the tree of a formula, in which numbers and places [..] are texts."""
    need(text.isascii() and not re.search(r"\+\+|--|//|['\"\\#]", text), f"no formula: {text[:60]!r}")
    return ast.parse(ATOM.sub(r"'\1'", text.strip()), mode="eval").body


def computed(node, names):
    match node:
        case ast.Constant(value=str(text)):
            return names["at"](text)
        case ast.Name(id=name):
            return names[name]
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return -computed(inner, names)
        case ast.BinOp(left=left, op=ast.Pow(), right=right):
            return names["power"](computed(left, names), computed(right, names))
        case ast.BinOp(left=left, op=sign, right=right):
            return OPERATORS[type(sign)](computed(left, names), computed(right, names))
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
            return names[name](*(computed(each, names) for each in arguments))
    raise ValueError(f"no formula: {ast.unparse(node)[:60]}")


def value(text, names):
    """Return the value of a formula, or of a choice of C; numbers, functions, powers, choices are those of names."""
    if choice := CHOICE.fullmatch(text):
        return names["choose"](choice[2], *(value(each, names) for each in choice.group(1, 3, 4, 5)))
    return computed(parsed(text), names)


def with_texts(names, texts):
    """Return names with the functions that texts define."""
    return names | {f: lambda *x, f=f: value(texts[f], names | dict(zip("xyzw", x, strict=False))) for f in texts}


def power(base, exponent):
    need(abs(exponent) < 99 and type(found := base**exponent) is type(base), f"no power: {exponent}")
    return found


def with_series(said):
    """Return the texts of safe functions, by series up to a split where they are said, and the coefficients of those.

    Terms alternate and fall, so that what is left out is less than the first term left out.
    """
    texts, coefficients = dict(SAFE), set()
    for f, split, terms, rest in ([each[0], *map(Fraction, each[1:])] for each in said):
        taylor = [Fraction((-1) ** k * TAYLOR[f](k), math.factorial(2 * k + 3)) for k in range(int(terms) + 1)]
        sizes = [abs(each) * split**k for k, each in enumerate(taylor)]
        holds = sorted(sizes, reverse=True) == sizes and rest == sizes[-1] / (sizes[0] - sizes[1])
        need(holds, f"the bound of the series of {f} is another")
        series = " + ".join(f"({each})*x**{2 * k}" for k, each in enumerate(taylor[:-1]))
        texts[f] = f"x*x < {split} ? {series} : {SAFE[f]}"
        coefficients |= {*map(abs, taylor)}
    return texts, coefficients


@cache
def sine(x):
    x %= 2 * Decimal(PI)
    total, term, k = Decimal(0), x, 1
    while abs(term) > Decimal("1e-100"):
        total, term, k = total + term, -term * x * x / ((k + 1) * (k + 2)), k + 2
    return total


def cosine(x):
    return sine(x + Decimal(PI) / 2)


def atan2(y, x):
    angle = Decimal(math.atan2(y, x))
    for _ in range(2):  # 16 digits, 48, 144
        angle += (y * cosine(angle) - x * sine(angle)) / (x * x + y * y).sqrt()
    return angle


REAL = {"sin": sine, "cos": cosine, "atan2": atan2, "sqrt": Decimal.sqrt, "fabs": abs, "copysign": Decimal.copy_sign}
REAL |= {"exp": Decimal.exp, "log": Decimal.ln, "at": Decimal, "power": power, "pi": Decimal(PI)}
TEXTS = SAFE | {  # and what the functions are that numbers have no method for
    "tan": "sin(x)/cos(x)",
    "asin": "atan2(x, sqrt(1 - x**2))",
    "acos": "atan2(sqrt(1 - x**2), x)",
    "atan": "atan2(x, 1)",
    "sinh": "(exp(x) - exp(-x))/2",
    "cosh": "(exp(x) + exp(-x))/2",
    "tanh": "1 - 2/(exp(2*x) + 1)",
}


def of_length_one(numbers):
    size = sum(each * each for each in numbers).sqrt()
    return [each / size for each in numbers]


def rotation(quaternion):
    """Return the rows of a rotation, one after the other."""
    a, *v = quaternion
    turns = [(i, j, (0, 1, -1)[(i - j) % 3] * a * v[(-i - j) % 3]) for i, j in product(range(3), repeat=2)]
    return [2 * (v[i] * v[j] + turn) + (i == j) * (2 * a * a - 1) for i, j, turn in turns]
