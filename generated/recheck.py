"""Re-verify kernels from their files alone: `python recheck.py NAME.cert.json ..`; standard library, nothing of symrot.

Every hash. Link 3, C text = formulas: both are evaluated at random fractions (recheck_c.py). Link 1, formulas obey
laws: to 90 digits at random points where what is given holds, until 16 in a row choose nothing new. A law that fails by
less than 1e-60 of its size, or near few points alone, is not noticed: `symrot audit` proves laws. Headers are known by
hash alone. Whatever else a certificate says (proofs of laws, titles, units, counts and digests of operations, flags,
theorems, bounds of rounding errors, object code) is a statement that is not looked at.
"""

# mypy: ignore-errors
import hashlib
import json
import re
import secrets
import sys
from collections import defaultdict
from decimal import Context, Decimal, localcontext
from fractions import Fraction
from itertools import product
from pathlib import Path

if __package__:
    from .recheck_c import check_c
    from .recheck_formula import REAL, TEXTS, need, of_length_one, power, rotation, value, with_texts
else:  # as a script, beside the other files: `python -I` does not look there
    sys.path.insert(0, str(Path(__file__).parent))
    from recheck_c import check_c
    from recheck_formula import REAL, TEXTS, need, of_length_one, power, rotation, value, with_texts

KIND = r"(void|static inline double|static inline float)"
HEAD = re.compile(KIND + r" (\w+)\( ?([^()]*)\) \{((?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*)\} ?", re.A)
REFUSALS = (ArithmeticError, AttributeError, LookupError, MemoryError, OSError, RecursionError, SyntaxError, TypeError)
REFUSALS += (ValueError,)
QUATERNION, ROTATION = [f"q{k}" for k in range(4)], [f"R_{i}{j}" for i, j in product((1, 2, 3), repeat=2)]


def implied(given):
    """Tell whether what is given implies that q is of length one, and whether it implies that R is a rotation."""
    free = defaultdict(lambda: Fraction(secrets.randbits(64)), at=Fraction, power=power)
    said = {value(text, free) for text in given}
    a, b, c = rows = [[free[name] for name in ROTATION[start : start + 3]] for start in (0, 3, 6)]
    wanted = {sum(x * y for x, y in zip(p, q, strict=True)) - (p is q) for p, q in product(rows, repeat=2)}
    wanted |= {a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] - c[k] for k in range(3)}
    return sum(free[name] ** 2 for name in QUATERNION) - 1 in said, wanted <= said


def check_law(law, formulas):
    """Link 1: refuse a law that formulas do not obey at random points, measured by what it is without them."""
    is_unit, is_rotation = implied(law["given"])
    need(not law["given"] or is_unit or is_rotation, f"the law {law['law']!r} is given what no points are known of")
    met, quiet = set(), 0
    for _ in range(400):
        ways, scale = [], Decimal(10) ** (secrets.randbelow(5) - 2)

        def choose(sign, a, b, x, y, ways=ways):
            ways.append({"<": a < b, ">=": a >= b, "==": a == b}[sign])
            return x if ways[-1] else y

        functions = with_texts(REAL | {"choose": choose}, TEXTS)
        free = defaultdict(lambda scale=scale: scale * (secrets.randbits(256) - 2**255) / 2**255, functions)
        unit, turn = (of_length_one([free[f"{name}{k}"] for k in range(4)]) for name in ("q", "turn "))
        names = free.copy()
        names.update(zip(QUATERNION, unit, strict=True) if is_unit else ())
        names.update(zip(ROTATION, rotation(turn), strict=True) if is_rotation else ())
        try:
            for name, text in formulas:
                names[name] = value(text, names)
            given = [abs(value(text, names)) for text in law["given"]]
            left = [abs(value(text, names)) for text in law["vanishing"]]
            chosen = tuple(ways)
            sizes = [abs(value(text, free)) for text in law["vanishing"]]
        except ArithmeticError:
            continue  # a point where something is not defined
        need(all(each < Decimal("1e-60") for each in given), f"what is given for the law {law['law']!r} is not known")
        holds = all(each <= size * Decimal("1e-60") + Decimal("1e-65") for each, size in zip(left, sizes, strict=True))
        need(holds, f"the law {law['law']!r} does not follow")
        quiet = quiet + 1 if chosen in met else 0
        met.add(chosen)
        if quiet == 16:
            return
    raise ValueError(f"the law {law['law']!r} is defined at too few points")


def functions_of(text, includes):
    """Return name -> (kind, arguments, body) of the functions of a C file that holds nothing else."""
    need(not re.search(r"\\|\?\?|[\0-\x09\x0b-\x1f]", text), "there is a backslash, a trigraph or a control character")
    lines = re.sub(r"/\*.*?\*/", " ", text, flags=re.S).split("\n")
    text = " ".join(" ".join(line for line in lines if line.strip() not in includes).split())
    found = {name: (kind, arguments, body) for kind, name, arguments, body in HEAD.findall(text)}
    need(not HEAD.sub("", text) and len(found) == len(HEAD.findall(text)), "there is more than functions, or one twice")
    return found


def certified(path):
    """Return what a certificate says, after its seal and the hashes of all its files."""
    path, directory = Path(path), Path(path).parent
    data = json.loads(path.read_bytes())
    need(isinstance(data, dict) and data.get("schema") == "symrot.certificate/1", "the schema is another")
    bare = json.dumps({k: v for k, v in data.items() if k != "seal"}, sort_keys=True, separators=(",", ":"))
    need(hashlib.sha256(bare.encode()).hexdigest() == data["seal"], "the certificate is not as it was printed")
    name, files = data["kernel"], data["files"]
    need(path.name == f"{name}.cert.json" and {f"{name}.c", f"{name}.h"} <= {*files}, "it is that of another file")
    for file, digest in files.items():
        if not file.startswith("../") or (directory / file).exists():
            content = (directory / file).read_bytes()
            need(hashlib.sha256(content).hexdigest() == digest, f"{file} is not what was certified")
    return data


def check(path):
    """Return what a certificate shows, in a line; raise one of REFUSALS if it does not."""
    data = certified(path)
    name, files, spec, readback = data["kernel"], data["files"], data["spec"], data["readback"]
    includes = ["#include <math.h>", f'#include "{name}.h"', *['#include "symrot_math.h"'] * ("symrot_math.h" in files)]
    found = functions_of(Path(path).with_name(f"{name}.c").read_text("utf-8"), includes)
    wanted = {f"{function}{end}" for function in readback for end in ("", "_batch")}
    need({f for f in found if found[f][0] == "void"} == wanted, f"expected the functions {', '.join(wanted)}")
    kinds = {"void", *(f"static inline {said['type']}" for said in readback.values())}
    need({kind for kind, _, _ in found.values()} <= kinds, "a function is of another type")
    for function in readback:
        check_c(function, data, found)
    need(data["laws"], "there are no laws")
    with localcontext(Context(prec=90)):
        for law in data["laws"]:
            check_law(law, [*spec["named"], *(item[1:] for item in spec["formulas"])])
    return f"{name}: {len(files)} hashes, C text of {' and '.join(readback)} and batches, {len(data['laws'])} laws"


def sentence(reason):
    """Return what is wrong, in a line."""
    known = isinstance(reason, ValueError | OSError)
    return str(reason) if known else f"no text of kernels, or no certificate of the schema ({reason!r})"


def main(paths):
    for path in paths or sys.exit("usage: python recheck.py NAME.cert.json .."):
        try:
            print(f"{check(path)}: hold")
        except REFUSALS as reason:
            sys.exit(f"{path}: {sentence(reason)}")


if __name__ == "__main__":
    main(sys.argv[1:])
