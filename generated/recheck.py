"""Re-verify kernels from their files alone: `python recheck.py NAME.cert.json ..`; standard library, nothing of symrot.

Hashes; link 3, that the C text is its formulas, exactly; link 1, that the formulas obey their laws. Exit 0 and a line
for each certificate that holds, exit 1 and a sentence for the first that does not. Its exact arithmetic is that of
recheck_formulas.py beside it. It trusts the two files, and Python."""

# ruff: noqa
# mypy: ignore-errors
# fmt: off
import hashlib, json, re, sys
from fractions import Fraction as F
from importlib import import_module
from pathlib import Path

exact = import_module(".recheck_formulas" if __package__ else "recheck_formulas", __package__)
ARITY, ONE, SAFE, TAYLOR, Formulas, complete, nearest, need, prove, same, variable = (getattr(exact, name) for name in (
    "ARITY ONE SAFE TAYLOR Formulas complete nearest need prove same variable".split()))

HEAD = re.compile(r"(static inline |)(void|double|float) (\w+)\( ?([^()]*)\) \{(.*)", re.A)
LOOP = "{} SYMROT_INDEPENDENT for (size_t k = 0; k < n; ++k) {{{}}} "
BLOCKS = ("{} for (size_t start = 0; start < n; start += SYMROT_BLOCK) {{ "
          "const size_t end = n - start < SYMROT_BLOCK ? n : start + SYMROT_BLOCK; uint{}_t beyond = 0; "
          "SYMROT_INDEPENDENT for (size_t k = start; k < end; ++k) {{{}beyond += {}; }} "
          "const size_t again = beyond == 0 ? start : end; for (size_t k = start; k < again; ++k) {{{}}} }} ")
PI = sum(F(k * (-1)**n, (2*n + 1) * d**(2*n + 1)) for k, d in ((16, 5), (-4, 239)) for n in range(60))

def safe(name, real, found, series):
    """Link 3, for a static function: it is one of those that formulas call, a series up to the bound that is said."""
    bare = name.removeprefix("symrot_").removesuffix("f" * (real == "float"))
    _, returns, arguments, body = found[name]
    names, own = [a.removeprefix(f"{real} ") for a in arguments.split(", ")], {x: variable(x) for x in "xyzw"}
    need(returns == real and len(names) == ARITY[bare] and all(map(str.isidentifier, names)), f"other arguments of {name}")
    wanted, atoms = SAFE[bare], []
    if bare in TAYLOR:
        (split, terms, rest), = [(F(s), n, F(r)) for function, s, n, r in series if function == bare]
        falling = [abs(TAYLOR[bare](k)) * split**k for k in range(terms + 1)]
        holds = sorted(falling, reverse=True) == falling and rest == falling[-1] / (falling[0] - falling[1])
        summed = [f"({nearest(TAYLOR[bare](k), real)})" + f"*x**{2 * k}" * (k > 0) for k in range(terms)]
        wanted = wanted.format(need(holds, f"the bound of the series of {bare} is another") and split, " + ".join(summed))
    (way, got), (wanted_way, want) = (Formulas(dict(zip(names, own.values())), atoms, real).run(body, names),
                                      Formulas(own, atoms).choice(wanted))
    need(way == wanted_way and all(map(same, got, want)), f"{name} is not {wanted}")

def near(text):
    """A text of one sample as batches have it, where angles are in the range of symrot_math.h."""
    text = re.sub(r"\bsymrot_(sinc|sine_gap|tangent_gap)(f?)\(", r"symrot_near_\1\2(", text)
    return re.sub(r"(?<!\w)(sin|cos)(f?)\(", r"symrot_\1\2(", text)

def equal(name, data, found):
    """Link 3: a function, of one sample and of many, is the formulas."""
    said, spec, places = data["readback"][name], data["spec"], {place: symbol for place, symbol, _ in data["inputs"]}
    need(len(places) == len(data["inputs"]) and all(map(str.isidentifier, places.values())), "an input is no symbol")
    formulas, real, end = {p: text for p, _, text in spec["formulas"]}, said["type"], "f" * (said["type"] == "float")
    sizes = {place.partition("[")[0]: 0 for place in (*places, *formulas)}
    for place in (*places, *formulas): sizes[place.partition("[")[0]] += "[" in place
    const = {base: "const " * (f"{base}[0]" not in formulas) for base in sizes}
    one = {base: f"{const[base]}{real} {base}[{size}]" if size else f"{real} {base}" for base, size in sizes.items()}
    many = [one[base] if base == "p" else f"{const[base]}{real} *SYMROT_RESTRICT {base}" for base in sizes]
    need(found[name][1:3] == ("void", ", ".join(one.values())), f"{name} has other arguments")
    need(found[f"{name}_batch"][1:3] == ("void", ", ".join(["size_t n", *many])), f"{name}_batch has other arguments")
    meant = {F(written): Formulas({"pi": variable("pi")}, []).read(text) for written, text in said["constants"]}
    for value, (above, below) in meant.items():
        exact = below == ONE and set(above) <= {(), (("pi", 1),)} and sum(k * (PI if m else 1) for m, k in above.items())
        need(exact and nearest(exact, real) == value, f"{value} stands for something else")
    static, atoms, body = [f for f in found if found[f][0] and found[f][1] == real], [], found[name][3]
    for each in static:
        if each.startswith("symrot_near_"):
            _, returns, arguments, plain = found[each.replace("near_", "")]
            chosen = re.sub(r"return (\w+) (<|==) (.*?) \? (.*?) : (.*);", lambda m: "return symrot_select_"
                            f"{'lt' if m[2] == '<' else 'eq'}{end}({', '.join(m.group(1, 3, 4, 5))});", plain)
            need(found[each][1:] == (returns, arguments, near(chosen)), f"{each} is another function")
        else: safe(each, real, found, said["series"])
    free = Formulas({}, atoms, taken=[])
    names = {place: free.read(spec["parameters"].get(symbol, symbol)) for place, symbol in places.items()}
    got = Formulas(names | dict.fromkeys(static), atoms, real, meant).run(body, sizes, formulas)
    symbols = re.findall(r"[A-Za-z_]\w*", " ".join(["pi", *places.values(), *spec["parameters"].values()]))
    reader = Formulas({symbol: variable(symbol) for symbol in symbols}, atoms)
    for symbol, text in spec["named"]: reader.names[symbol] = reader.read(text)
    for place, text in formulas.items(): need(same(got[place], reader.read(text)), f"{place} of {name} is not its formula")
    silent, rest = re.fullmatch(r"((?: \(void\)\w+;)*)(.*)", body).groups()
    for base in reversed([base for base in sizes if not sizes[base] and re.search(rf"\b{base}\b", rest)]):
        rest = f" const {real} {base}_k = {base}[k];" + re.sub(rf"\b{base}\b", f"{base}_k", rest)
    rest, body = re.sub(r"\b(?!p\[)(\w+)\[(\d+)\]", r"\1[\2*n + k]", rest), found[f"{name}_batch"][3]
    turned, asked = (re.findall(rf"symrot_{f}f?\(((?:[^()]|\([^()]*\))*)\)", body) for f in ("(?:sin|cos|near_\\w+?)", "far"))
    far = " + ".join(f"symrot_far{end}({each})" for each in asked)
    blocks = BLOCKS.format(silent, 32 if end else 64, near(rest), far, rest)
    holds = body == LOOP.format(silent, rest) or body == blocks and set(turned) <= set(asked)
    need(holds, f"{name}_batch does not compute what {name} does")

def check(path):
    """Return what a certificate shows, in a line; raise one of REFUSALS if it does not."""
    path, found, directory = Path(path), {}, Path(path).parent
    data = json.loads(path.read_bytes())
    need(isinstance(data, dict) and data.get("schema") == "symrot.certificate/1", "expected the schema symrot.certificate/1")
    bare = json.dumps({key: each for key, each in data.items() if key != "seal"}, sort_keys=True, separators=(",", ":"))
    need(hashlib.sha256(bare.encode()).hexdigest() == data["seal"], "the certificate is not as it was printed")
    name, files = data["kernel"], data["files"]
    need(path.name == f"{name}.cert.json" and {f"{name}.c", f"{name}.h"} <= {*files}, "it is that of another file")
    for file, digest in files.items():
        if not file.startswith("../") or (directory / file).exists():
            need(hashlib.sha256((directory / file).read_bytes()).hexdigest() == digest, f"{file} is not what was certified")
    text = (directory / f"{name}.c").read_text("utf-8")
    need(not re.search(r"\\|\?\?|[\0-\x09\x0b-\x1f]", text), "there is a backslash, a trigraph or a control character")
    included = ["#include <math.h>", f'#include "{name}.h"'] + ['#include "symrot_math.h"'] * ("symrot_math.h" in files)
    lines = [line for line in re.sub(r"/\*.*?\*/", " ", text, flags=re.S).split("\n") if line.strip() not in included]
    for chunk in re.split(r"^\}$", "\n".join(lines), flags=re.M)[:-1]:
        head = need(HEAD.fullmatch(" ".join(chunk.split()) + " "), f"no function: {chunk.strip()[:60]!r}")
        need(head[3] not in found and (not head[1] or head[3].startswith("symrot_")), f"a second definition of {head[3]}")
        found[head[3]] = head.group(1, 2, 4, 5)
    shown = {f for f in found if not found[f][0]}
    named = {f + end for f in data["readback"] for end in ("", "_batch")}
    need(not lines[-1].strip() and shown == named, f"expected the functions {', '.join(named)}")
    for each in data["readback"]: equal(each, data, found)
    formulas = [*data["spec"]["named"], *(item[1:] for item in data["spec"]["formulas"])]
    for law in need(data["laws"], "there are no laws"):
        need(complete([case["case"] for case in law["cases"]]), f"cases of the law {law['law']!r} are missing")
        for case in law["cases"]: prove(law, case, formulas)
    functions, laws = " and ".join(data["readback"]), len(data["laws"])
    return f"{name}: {len(files)} hashes, C text of {functions} and batches = formulas, {laws} laws of the formulas"

REFUSALS = (LookupError, TypeError, AttributeError, SyntaxError, MemoryError, RecursionError, ValueError,
            ArithmeticError, OSError)
def sentence(reason):
    return str(reason) if isinstance(reason, (ValueError, OSError)) else f"no certificate of the schema ({reason!r})"
def main(paths):
    for path in paths or sys.exit("usage: python recheck.py NAME.cert.json .."):
        try: print(check(path), "hold", sep=": ")
        except REFUSALS as reason: sys.exit(f"{path}: {sentence(reason)}")
if __name__ == "__main__": main(sys.argv[1:])
