"""Advice for formulas in the notation of other languages: what to write instead. Imported only on errors.

Standard library only.
"""

from collections.abc import Collection

__all__ = ["function_advice", "mark_advice", "name_advice"]

SIGNATURES = {  # signatures of functions with more than one argument
    "atan2": "atan2(y, x)", "min": "min(a, b)", "max": "max(a, b)", "clip": "clip(u, low, high)", "mod": "mod(a, b)",
    "where": "where(condition, a, b)",
}  # fmt: skip

JUMPING = ("step", "sign", "min", "max", "clip", "floor", "mod", "where")

_FUNCTIONS = {  # formula -> names of such a function in other languages
    "step(u)": "heaviside unitstep unit_step theta u1",
    "sign(u)": "sgn signum copysign signbit",
    "abs(u)": "fabs absolute magnitude",
    "min(a, b)": "minimum fmin amin",
    "max(a, b)": "maximum fmax amax relu",
    "clip(u, low, high)": "saturate saturation sat clamp constrain limit bound limiter",
    "mod(a, b), which has the sign of b": "fmod rem remainder modulo modulus",
    "where(condition, a, b)": "if ifelse if_else iif piecewise select cond switch case merge",
    "floor(u)": "int int32 entier",
    "floor(u + 1/2)": "round rint nint around",
    "-floor(-u)": "ceil ceiling",
    "where(u < 0, -floor(-u), floor(u))": "trunc fix truncate",
    "u - floor(u)": "frac fract",
    "log(u)": "ln loge",
    "log(u)/log(10)": "log10 lg",
    "log(u)/log(2)": "log2 lb",
    "log(1 + u)": "log1p",
    "exp(u) - 1": "expm1",
    "exp(u*log(2))": "exp2",
    "asin(u)": "arcsin arsin",
    "acos(u)": "arccos arcos",
    "atan(u)": "arctan arctg",
    "atan2(y, x)": "arctan2 arg angle",
    "tan(u)": "tg",
    "1/tan(u)": "cot ctg cotan",
    "1/cos(u)": "sec",
    "1/sin(u)": "csc cosec",
    "1/cosh(u)": "sech",
    "1/sinh(u)": "csch",
    "1/tanh(u)": "coth",
    "tanh(u)": "th",
    "sqrt(u)": "root squareroot",
    "u**n, with a whole number n": "pow power",
    "u**2": "sq sqr",
    "sqrt(a**2 + b**2)": "hypot",
    "exp(log(u)/3), for u > 0": "cbrt nthroot",
    "u*pi/180": "deg2rad radians rad",
    "u*180/pi": "rad2deg degrees deg",
    "sign(sin(u))": "square squarewave",
    "2*mod(u/(2*pi), 1) - 1": "sawtooth",
    "where(abs(u) < 1/2, 1, 0)": "rect rectpuls boxcar",
    "max(0, 1 - abs(u))": "tri tripuls triang",
    "exp(-(u/w)**2)/(w*sqrt(pi)), a pulse of width w": "dirac diracdelta delta impulse",
}  # fmt: skip
FUNCTIONS = {word: write for write, words in _FUNCTIONS.items() for word in words.split()}

_NAMES = {
    "t": "T time tau",
    "pi": "Pi PI π",
    "exp(1)": "e E",
    "a comparison such as t < 1": "True False true false",
    "and, or and not between comparisons": "and or not",
    **{
        f"omega_{number}": f"omega_{axis} omega{axis} w{axis} w_{axis} {other} omega{number} w{number} w_{number}"
        for number, axis, other in ((1, "x", "p_b"), (2, "y", "q_b"), (3, "z", "r_b"))
    },
    "q0": "qw q_w q_0", "q1": "qx q_x q_1", "q2": "qy q_y q_2", "q3": "qz q_z q_3",
}  # fmt: skip
NAMES = {word: write for write, words in _NAMES.items() for word in words.split()}

_EQUAL = "a formula that varies equals a number only at single instants"
MARKS = {
    "%": "mod(a, b) for a % b", "^": "** for a power", "&": "'and' between conditions",
    "|": "'or' between conditions, and abs(u) for |u|", "!": f"'not' before a condition; {_EQUAL}",
    "~": "'not' before a condition", "=": f"< or > with a number on each side: {_EQUAL}",
    "[": "omega_1, omega_2, omega_3 or q0 .. q3 for one component", "{": "round brackets",
    ".": "functions without np. or math. before them", ":": "where(condition, a, b)", "?": "where(condition, a, b)",
    ";": "one formula alone", "π": "pi", "²": "**2", "³": "**3", "−": "-", "–": "-", "·": "*", "×": "*", "÷": "/",
    "√": "sqrt(u)", "≤": "<=", "≥": ">=", "≠": "< or >", "ω": "omega_1, omega_2 or omega_3", "∧": "and", "∨": "or",
    "'": "the formula without quotes", '"': "the formula without quotes", "\\": "the formula without LaTeX",
}  # fmt: skip


def nearest(word: str, known: Collection[str]) -> str:
    """Return the entry of ``known`` that is most similar to a mistyped word, or an empty text if none is similar."""
    from difflib import get_close_matches

    close = get_close_matches(word.lower(), list(known), 1, 0.5)
    return close[0] if close else ""


def function_advice(name: str, known: Collection[str]) -> str:
    """Return what to write instead of the function ``name``, or an empty text: ``write sign(u)`` for ``sgn``.

    ``known`` holds the functions that are allowed here.
    """
    # a known function with wrong arguments
    if name in known:
        return f"write {SIGNATURES.get(name, f'{name}(u)')}"
    if name in JUMPING:
        return "functions that jump or have a kink are allowed only in formulas of torques"
    if name in NAMES.values():
        return f"write * between {name} and a bracket"
    write = FUNCTIONS.get(name.lower(), "")
    if write and all(word in known for word in _called(write)):
        return f"write {write}"
    close = nearest(name, known)
    return f"did you mean '{close}'?" if close else ""


def _called(text: str) -> list[str]:
    """Return the names of the functions that a formula calls."""
    import re

    return re.findall(r"([a-z]\w*)\(", text)


def name_advice(name: str, known: Collection[str]) -> str:
    """Return what to write instead of the unknown name ``name``, or an empty text; ``known`` holds the allowed names.

    For example, ``T`` gives ``write t``.
    """
    write = NAMES.get(name, "") or NAMES.get(name.lower(), "")
    if write and (write in known or "(" in write or " " in write):
        return f"write {write}"
    close = nearest(name, known)
    return f"did you mean '{close}'?" if close else ""


def mark_advice(source: str, position: int, known: Collection[str]) -> str:
    """Return what to write instead of the text at ``position`` of a formula: ``write ** for a power`` for ``^``."""
    # the reader met a character that is no operator, or missed an operator
    rest, before = source[position:], source[:position].rstrip()
    if rest[:1] in MARKS:
        return f"write {MARKS[rest[0]]}"
    word = rest.split("(")[0].split()[:1]
    if word and word[0] in ("if", "else", "then"):
        return "write where(condition, a, b)" if "where" in known else ""
    if word and word[0] == "xor":
        return "combine conditions with 'and', 'or' and 'not'"
    last = before.replace("(", " ").split()[-1:]
    if last and last[0] in known and rest and before[-1] != "(":
        return f"write {last[0]}(..), with brackets"
    if rest and (rest[0].isalnum() or rest[0] in "_(") and before and (before[-1].isalnum() or before[-1] in "_)"):
        return "write * between factors"
    return ""
