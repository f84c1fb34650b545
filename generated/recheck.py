"""Re-verify kernels from their files alone: `python recheck.py NAME.cert.json ..`; standard library, nothing of symrot.

Every hash. Link 3, C text = formulas: exactly, at a random point of fractions, where functions are any functions and
choices any means of their two ways; what series leave out is computed at 64 random points. Link 1, formulas obey laws:
to 60 digits at 8 random points where what is given holds, of numbers up to 1000, at 64 if they choose. What fails by
less, or only near few points or far out, is not noticed: `symrot audit` proves. Link 4, rounding errors within their
bounds: at a random point of a box without holes, so that `(x + 1e20) - 1e20` is refused; not after conversions whose
box has holes. Headers hold known macros and prototypes alone, and symrot_math.h is the one below by its hash; NumPy
texts are known by hash alone. That a kernel is what its name says, and what else is said (proofs, titles, operations,
flags, theorems, object code), is not looked at, nor where C is defined. Names that end in _ are of this file alone.
"""

# mypy: ignore-errors
import ast
import json
import math
import re
import sys
from collections import Counter, defaultdict
from ctypes import c_double, c_float
from decimal import Context, Decimal, localcontext
from fractions import Fraction
from functools import cache, partial
from hashlib import sha256
from pathlib import Path
from secrets import randbelow

PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803482534211707")


@cache
def sine(x):
    """Return the sine by 60 terms of its series, those of high powers first."""
    x = x % (2 * PI)
    square, total = x * x, 1
    for k in range(118, 0, -2):
        total = 1 - total * square / (k * (k + 1))
    return x * total


PLAIN = {"sin": sine, "cos": lambda x: sine(x + PI / 2), "sqrt": Decimal.sqrt, "fabs": abs}
PLAIN |= {"copysign": Decimal.copy_sign, "nearly_": lambda y, x: Decimal(math.atan2(y, x))}
OTHERS = ("tan", "asin", "acos", "atan", "exp", "log", "sinh", "cosh", "tanh")  # any functions, in laws too
MEANS = {"atan2": "closer_(x, y, closer_(x, y, nearly_(x, y)))", "closer_": "z + (x*cos(z) - y*sin(z))/sqrt(x*x + y*y)"}
MEANS |= {"select_lt": "x < y ? z : w", "select_eq": "x == y ? z : w", "select_ge": "x >= y ? z : w", "Abs": "fabs(x)"}
LARGEST = 16_000_000  # bytes of a file
MATH = "ec48bca7f8eb7ed77612704a0672155f4af0330d0679ba59524c5cfb5f5b0a19"  # symrot_math.h
HEADER = """#ifndef SYMROT_@_H
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
#endif
?#ifndef SYMROT_SPAN
#define SYMROT_SPAN 2048
#endif
?#ifdef __cplusplus
extern "C" {
#endif
?#ifdef __cplusplus
}
#endif
#endif"""
NODES = (ast.Expression, ast.BinOp, ast.UnaryOp, ast.Call, ast.Name, ast.Constant, ast.operator, ast.USub, ast.Load)
ATOM = re.compile(r"(?<![\w.])(\w+\[[^]]*\]|\d[\w.]*(?:(?<=e)[-+]\w+)?)")
CHOICE = re.compile(r"^([^?:<>=]+) (<|>=|==) ([^?:<>=]+) \? ([^?:<>=]+) : ([^?:<>=]+)")
FUNCTION = r"(void|static inline \w+) (\w+)\(([\w *,[\]]*)\) \{((?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*)\} ?"
ODD = r"\+\+|--|//|['\"\\#]|\b(_|SYMROT_|(True|False|None)\b)|(?<!\d)\.|\*\*(?!\(?-?\d\d?\b(?! *\*\*))|\de[-+]?\d{3}"
STATEMENT = r" (?:const (\w+) )?(?!beyond =)(\w+(?:\[[^]]*\])?(?= =)|beyond(?= \+=)|return) (?:\+?= )?([^;{}]+);"
EACH = " SYMROT_INDEPENDENT for (size_t k = 0; k < n; ++k) {} "
LOOP = EACH.replace("0", "start").replace("n;", "end;")
SPAN = " for (size_t start = 0; start < n; start += @) { const size_t end = n - start < @ ? n : start + @;"
PARTS = SPAN.replace("@", "SYMROT_SPAN") + LOOP + LOOP[1:] + "} "
BLOCKS = SPAN.replace("@", "SYMROT_BLOCK") + f" uint%s_t beyond = 0;{LOOP}const size_t again = beyond == 0 ? "
BLOCKS += "start : end; for (size_t k = start; k < again; ++k) {} } "


def need(holds, said):
    if not holds:
        raise ValueError(said)


@cache
def formula(text):
    """Return what a formula, or a choice of C, is of names; numbers and places [..] are looked up by ``at_``."""
    need(text.isascii() and not re.search(ODD, text), f"no formula: {text[:60]!r}")
    tree = ast.parse(CHOICE.sub(r"if_('\2', (\1), (\3), (\4), (\5))", ATOM.sub(r"at_('\1')", text.strip())), "", "eval")
    need(all(isinstance(node, NODES) for node in ast.walk(tree)), f"no formula: {text[:60]!r}")
    return partial(eval, compile(tree, "a formula", "eval"), {"__builtins__": {}})


def point(given, formulas, functions, number=Decimal):
    """Return random numbers by name where what is given holds, and functions: with fractions, any, and any choices."""

    def choose(sign, a, b, x, y):
        way = names[sign, a, b] if number is Fraction else {"<": a < b, ">=": a >= b, "==": a == b}[sign]
        return x * way + y * (1 - way)

    s, names = 2 ** randbelow(11), defaultdict(lambda: s * number(randbelow(2**99) - 2**98) / 2**98, PLAIN, if_=choose)
    names |= {f: lambda *x, f=f: names[(f, *x)] for f in (*OTHERS, *PLAIN) if f in OTHERS or number is Fraction}
    for function, text in [*MEANS.items(), *functions]:
        need(function not in names, f"{function} is no new function")
        names[function] = lambda *x, text=text: formula(text)(names | dict(zip("xyzw", x, strict=False)))
    turn = [names[each] for each in given[: 4 if given[8:] else None]]
    q = [each / sum(each * each for each in turn).sqrt() for each in turn]
    nine = ((i, j, q[i] * q[j] + (0, q[0], -q[0])[i - j] * q[(6 - i - j) % 4]) for i in (1, 2, 3) for j in (1, 2, 3))
    rotation = (2 * each + (i == j) * (2 * q[0] * q[0] - 1) for i, j, each in nine)
    names |= dict(zip(given, rotation if given[8:] else q, strict=True)) | {"pi": number(PI), "at_": number}
    try:
        for *_, name, text in formulas:
            need(name not in names, f"{name} is no new name")
            names[name] = formula(text)(names)
        return names
    except ArithmeticError:  # they are not defined there
        return point(given, formulas, functions, number)


def machine(end, nearest):
    """Return the arithmetic of C, by name: each operation and function rounded to the nearest number of a type."""

    def rounded(function):
        return lambda *x: kind(nearest(function(*x)).value)

    kind = type("rounded", (float,), {})
    for each in ("add", "radd", "sub", "rsub", "mul", "rmul", "truediv", "rtruediv", "neg", "abs"):
        setattr(kind, f"__{each}__", rounded(getattr(float, f"__{each}__")))
    names = {f: rounded(getattr(math, f)) for f in ("sin", "cos", "sqrt", "fabs", "copysign", "atan2", *OTHERS)}
    ways = {"lt": lambda x, y, z, w: z if x < y else w, "eq": lambda x, y, z, w: z if x == y else w}
    names |= {f"symrot_{f}": names[f] for f in ("sin", "cos", "atan2")} | {"symrot_far": lambda x: 0}
    names |= {f"symrot_select_{f}": way for f, way in ways.items()}
    names |= {"symrot_choose_ge": lambda x, y, z, w: z if x >= y else w}
    choose = {"<": ways["lt"], "==": ways["eq"], ">=": names["symrot_choose_ge"]}
    return {f + end: names[f] for f in names} | {
        "at_": lambda text: kind(nearest(float(text.removesuffix("f") if isinstance(text, str) else text)).value),
        "if_": lambda sign, *x: choose[sign](*x), "n": None, "k": None,
    }  # fmt: skip


def sample(data, bits, nearest, formulas, functions):
    """Return a random point of the box of rounding errors, the values there, and their bounds; none if it has holes."""
    bounds = data.get("rounding", {"clearance": "1", "precisions": []})
    if float.fromhex(bounds["clearance"]) or data["spec"]["parameters"]:
        return {}, {}
    names, symbols = point([], [], functions), {place: symbol for place, symbol, _ in data["inputs"]}
    for place, ends in bounds["box"].items():
        low, high = map(float.fromhex, ends)
        value = nearest(low + (high - low) * randbelow(2**53 + 1) / 2**53).value
        names[place] = names[symbols[place]] = Decimal(min(max(value, low), high))
    for *_, symbol, text in formulas[len(data["inputs"]) :]:
        names[symbol] = formula(text)(names)
    names |= {place: names[symbol] for place, symbol, _ in data["spec"]["formulas"]}
    found = [each["outputs"] for each in bounds["precisions"] if each["precision"] == f"binary{bits}"]
    return names, {each["output"]: Decimal(float.fromhex(each["absolute"])) for outputs in found for each in outputs}


def check_c(name, said, real, data, formulas, functions, found):
    """Link 3: refuse a function, of one sample and of many, that is not its formulas."""
    end, bits, nearest, least = {"double": ("", "64", c_double, 2**-55), "float": ("f", "32", c_float, 2**-26)}[real]
    numbers = said["constants"] + [[each.strip("-")] * 2 for _, _, series, _ in said["series"] for each in series]
    for f, split, series, rest in said["series"]:
        names, taylor = point([], [], functions), " + ".join(f"{Fraction(c)}*x**{2 * k}" for k, c in enumerate(series))
        within = [names | {"x": Decimal(float(Fraction(split))).sqrt() * randbelow(2**64) / 2**64} for _ in range(64)]
        left_out = max(abs(formula(f"({taylor})/{f}(x) - 1")(each)) for each in within)
        need(left_out <= min(Fraction(rest), least), f"the series of {f} leaves out {left_out:.3}")
        functions = [(each, f"x*x < {split} ? {taylor} : {text}" if each == f else text) for each, text in functions]
    names = point([], formulas, functions, Fraction)
    constants = {nearest(formula(written)(names)).value: formula(exact)(names) for written, exact in numbers}
    inputs = {place: names[(place,)] for place, symbol, _ in data["inputs"] if symbol.isidentifier()}
    need(len({names["pi"], *inputs.values()}) == len(data["inputs"]) + 1, "an input is no name, or two are one")
    need(all(nearest(constants[c]).value == c and c * 2**20 % 1 for c in constants), "a constant is another number")

    def number(text):
        need(re.fullmatch(rf"(\d+\.\d*|\d+(?=e))(e[-+]?\d+)?{end}", text), f"{text} is no {real}")
        return constants.get(written := nearest(float(text.removesuffix("f"))).value, Fraction(written))

    def run(body, places, own):
        """Return what statements give to places, or return."""
        local, given = own | places | {"at_": lambda text: local[text] if text in local else own["at_"](text)}, {}
        for kind, goal, text in re.findall(STATEMENT, body):
            need(kind in ("", real) and goal not in local | given, f"{goal} is no new {real}")
            (local if kind else given)[goal] = formula(text)(local)
        need(not re.sub(STATEMENT, "", body).strip(), f"no statement: {re.sub(STATEMENT, '', body)[:60]!r}")
        return given

    def call(own, listed, body, *x):
        return run(body, dict(zip(re.findall(rf"{real} (\w+)", listed), x, strict=True)), own)["return"]

    own = {f + end: names[f] for f in (*PLAIN, *MEANS, *OTHERS)} | {"n": None, "k": None, "if_": names["if_"]}
    own |= {f"symrot_{f}{end}": names[f] for f in ("select_lt", "select_eq", "atan2")}
    own |= {f"symrot_{f}{end}": lambda x, f=f: near.add(x) or names[f](x) for f in ("sin", "cos")}
    own |= {f"symrot_choose_ge{end}": names["select_ge"], f"symrot_far{end}": lambda x: [x]}
    need(
        not own.keys() & found.keys() and name == f"symrot_{data['kernel']}{end}",
        "a function has another meaning, or type",
    )
    own |= {"at_": number}
    doubles, exact, limits = machine(end, nearest), *sample(data, bits, nearest, formulas, functions)
    placed = {place: doubles["at_"](exact[place]) for place in inputs if limits}
    for each in (own, doubles):
        each |= {f: partial(call, each, *found[f][1:]) for f in found if found[f][0] == f"static inline {real}"}
    far = f"{name} is rounded by more than its bounds"
    places = [f"const {place}" for place in inputs] + [place for place, *_ in data["spec"]["formulas"]]
    sizes = Counter(place.partition("[")[0] for place in places)
    need(places == [b if b in places else f"{b}[{k}]" for b in sizes for k in range(sizes[b])], "arguments are others")
    for (_, listed, body), frames in (found[name], [""]), (found[f"{name}_batch"], [EACH, PARTS, BLOCKS % bits]):
        parts = re.split(r"(?<=\+\+k\) \{)([^{}]*)(?=\})", body)
        frame, loops = ("".join(parts[::2]), parts[1::2]) if parts[1:] else ("", parts)
        typed = [re.sub(rf"^{real} (?=\w+$)", "const ", each.strip()) for each in listed.split(",")]  # by value
        takes = [re.sub(rf"\b(size_t|{real}) (\*SYMROT_RESTRICT )?|\[\d+]$", "", each) for each in typed]
        need(frame in frames and takes == ["n"] * bool(frame) + [*sizes], f"arguments or loops of {name} are others")
        results = []
        for loop in loops:
            near = set()
            need(not frame or not re.search(r"(?<!\bp)\[\d+\]|\bp\[\d+\*", loop), f"{name} takes one sample alone")
            loop = re.sub(r"(\w+)\[k]", lambda m: m[1] if m[1] in inputs else f"{m[1]}[0]", loop) if frame else loop
            loop = loop.replace("[n + k]", "[1]").replace("*n + k]", "]") if frame else loop
            results.append(run(loop, inputs, own))
            rounded = run(loop, placed, doubles) if limits else {}
            need(all(abs(Decimal(rounded.get(p, 0)) - exact[p]) <= limits[p] for p in limits.keys() & rounded), far)
            need(near <= {*results[0].pop("beyond", [])}, f"functions of {name} take angles beyond their range")
        for result in [results[0] | results[1]] if frame == PARTS else results:
            need(result == {p: names[s] for p, s, _ in data["spec"]["formulas"]}, f"{name} is not its formulas")


def check_header(name, raw, found):
    """Refuse a header that holds more than the prototypes of the functions of its C file."""
    need(not re.search(r"[^\n -~]|\\|\?\?|//", raw), f"{name}.h holds what C may read in several ways")
    lines = [line.strip() for line in re.sub(r"/\*.*?\*/", " ", raw, flags=re.S).split("\n")]
    top, span, opened, end = map(re.escape, HEADER.replace("@", name.upper()).split("?"))
    held = re.fullmatch(rf"{top}({span})?{opened}([^#\"{{}}]*){end}", "\n".join(line for line in lines if line))
    bare = partial(re.sub, r" *([(),*;]) *", r"\1")
    heads = {bare(f"void {f}({listed})") for f, (kind, listed, _) in found.items() if kind == "void"}
    need(held and {*bare(" ".join(held[2].split())).split(";")} == {*heads, ""}, f"{name}.h holds more than prototypes")


def content(path):
    """Return the bytes of a regular file of a size that kernels have: nothing else is opened."""
    need(path.is_file() and path.stat().st_size <= LARGEST, f"{path.name} is no file of at most {LARGEST} bytes")
    return path.read_bytes()


def certified(path):
    """Return what a certificate says, after its seal and the hashes of all its files."""
    data = json.loads(content(path), object_pairs_hook=lambda pairs: len(dict(pairs)) == len(pairs) and dict(pairs))
    seal = data.pop("seal") == sha256(json.dumps(data, sort_keys=True, separators=(",", ":")).encode()).hexdigest()
    need(seal and data["schema"] == "symrot.certificate/1", "the schema is another, or the text that was sealed")
    name, files = data["kernel"], data["files"]
    need(path.name == f"{name}.cert.json" and {f"{name}.c", f"{name}.h"} <= {*files}, "it is that of another file")
    for file, digest in files.items():
        need(re.fullmatch(r"(\.\./){0,2}(\w+/)*\w+\.\w+", file), f"{file} is no file of a kernel")
        if "/" not in file or (path.parent / file).exists():
            need(sha256(content(path.parent / file)).hexdigest() == digest, f"{file} is not what was certified")
    return data


def check(path):
    """Return what a certificate shows, in a line; raise an exception if it does not."""
    data = certified(path)
    name, files, spec, readback = data["kernel"], data["files"], data["spec"], data["readback"]
    raw = path.with_name(f"{name}.c").read_text("utf-8")
    text = re.sub(r'/\*.*?\*/|\(void\)\w+;|#include (<math\.h>|"\w+\.h")(?=\n)', " ", raw, flags=re.S)
    rest, count = re.subn(FUNCTION, "", text := " ".join(text.split()))
    odd = rest or re.search(r"\*\*|['\"#%]", text) or re.search(r"[^\n -~]|\\|\?\?|//", raw)
    found = {f: (kind, listed, body) for kind, f, listed, body in re.findall(FUNCTION, text)}
    known = {f for f in found if found[f][0] == "void"} == {f + end for f in readback for end in ("", "_batch")}
    known = known and readback and {*re.findall('#.+ "(.+)"', raw)} <= {f"{name}.h", "symrot_math.h"} & {*files}
    known = known and len(found) == count and files.get("symrot_math.h", MATH) == MATH
    need(known and not odd and data["laws"], "laws or functions are others")
    check_header(name, path.with_name(f"{name}.h").read_text("utf-8"), found)
    formulas = [((p,), spec["parameters"].get(s, s)) for p, s, _ in data["inputs"]] + spec["named"] + spec["formulas"]
    need({s for p, s, _ in data["inputs"] + spec["formulas"] if p[:2] == "p["} == {*spec["parameters"]}, "p is another")
    with localcontext(Context(prec=190, Emax=120)):
        for law in data["laws"] * (64 if re.search("select_|Abs|copysign|[?]", str([spec, data["laws"]])) else 8):
            laws = [*enumerate(law["vanishing"])]
            left, size = (point(*each, spec["functions"]) for each in ((law["given"], formulas + laws), ([], laws)))
            holds = all(abs(left[k]) <= min(max(abs(size[k]) / 10**60, 1e-70), 1e-40) for k, _ in laws)
            need(holds and law["vanishing"][:0] == [] != laws, f"the law {law['law']!r} does not follow")
        for function, said in readback.items():
            check_c(function, said, said["type"], data, formulas, spec["functions"], found)
    return f"{name}: {len(files)} hashes, C text of {' and '.join(readback)} and batches, laws"


if __name__ == "__main__":
    for path in sys.argv[1:] or sys.exit("usage: python recheck.py NAME.cert.json .."):
        try:
            print(f"{check(Path(path))}: hold")
        except Exception as e:
            sys.exit(f"{path}: {e if isinstance(e, ValueError | OSError) else f'no certificate of the schema ({e!r})'}")
