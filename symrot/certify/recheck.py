"""Re-verify kernels from their files alone: `python recheck.py NAME.cert.json ..`; standard library, nothing of symrot.

Every hash; link 3, that the C text is its formulas, exactly; link 1, that the formulas obey their laws. Exit 0 and a
line for each certificate that holds, exit 1 and a sentence for the first that does not. It trusts Python and itself.
"""
import ast, hashlib, json, re, sys
from fractions import Fraction as F
from functools import lru_cache
from math import factorial
from pathlib import Path

NUMBER = re.compile(r"(?<![\w.])(\d+\.\d*(?:e[-+]?\d{1,3})?f?|\d+e[-+]?\d{1,3}f?)(?![\w.])")
HEAD = re.compile(r"(static inline |)(void|double|float) (\w+)\( ?([^()]*)\) \{(.*)", re.A)
STATEMENT = re.compile(r" (?:\(void\)(\w+)|(const \w+ \w+|\w+\[\d+\]) = ([^=]*)|return (.*))", re.A)
CHOICE = re.compile(r"([^?:<>=]*)(<|>=|==)([^?:<>=]*)\?([^?:<>=]*):([^?:<>=]*)")
LOOP = "{} SYMROT_INDEPENDENT for (size_t k = 0; k < n; ++k) {{{}}} "
BLOCKS = ("{} for (size_t start = 0; start < n; start += SYMROT_BLOCK) {{ const size_t end = n - start < SYMROT_BLOCK ? n : start + "
          "SYMROT_BLOCK; uint{}_t beyond = 0; SYMROT_INDEPENDENT for (size_t k = start; k < end; ++k) {{{}beyond += {}; }} "
          "const size_t again = beyond == 0 ? start : end; for (size_t k = start; k < again; ++k) {{{}}} }} ")
EXPLICIT = dict(sinc="sin(x)/x", arc_ratio="atan2(x, y)/x", sine_gap="(x - sin(x))/x**3",
                tangent_gap="(sin(x) - x*cos(x))/x**3", Abs="copysign(1, x)*x")
TAYLOR = dict(sine_gap=lambda k: F((-1)**k, factorial(2*k + 3)), tangent_gap=lambda k: F((-1)**k * (2*k + 2), factorial(2*k + 3)))
SAFE = dict(select_ge="x >= y ? z : w", sinc="x == 0 ? 1 : sin(x)/x", arc_ratio="x == 0 ? 1/y : atan2(x, y)/x",
            **{name: f"x*x < {{}} ? {{}} : {EXPLICIT[name]}" for name in TAYLOR})
ARITY = dict.fromkeys("sin cos tan asin acos atan exp log sinh cosh tanh sqrt Abs sinc sine_gap tangent_gap".split(), 1)
ARITY |= dict(atan2=2, copysign=2, arc_ratio=2, select_ge=4)
FACTS = {  # what functions are, whatever the arguments: left, right, left, right
    "sum": "sin({0} + {1}) = sin({0})*cos({1}) + cos({0})*sin({1}) = cos({0} + {1}) = cos({0})*cos({1}) - sin({0})*sin({1})",
    "odd": "sin(-{0}) = -sin({0}) = cos(-{0}) = cos({0})", "quarter": "sin({0} + pi/2) = cos({0}) = cos({0} + pi/2) = -sin({0})",
    "quarter back": "sin({0} - pi/2) = -cos({0}) = cos({0} - pi/2) = sin({0})",
    "arc": "sin(atan2({0}, {1})) = {0}/sqrt({0}**2 + {1}**2) = cos(atan2({0}, {1})) = {1}/sqrt({0}**2 + {1}**2)",
    "wrap": "sin(W) = sin({0}) = cos(W) = cos({0})".replace(
        "W", "select_ge(pi, {0}, select_ge({0}, -pi, {0}, {0} + 2*pi), {0} - 2*pi)")}
RELATIONS = dict(circle="sin({0})**2 + cos({0})**2 - 1", root="sqrt({0})**2 - {0}", sign="copysign(1, {0})**2 - 1")
RESERVED = "n k start end again beyond".split()
PI = sum(F(k * (-1)**n, (2*n + 1) * d**(2*n + 1)) for k, d in ((16, 5), (-4, 239)) for n in range(60))  # Machin

def need(holds, said):
    if not holds: raise ValueError(said)
    return holds
def nearest(value, real):  # number of the type nearest to a value, ties to even
    bits = {"double": 53, "float": 24}[real]
    shift = bits + value.denominator.bit_length() - abs(value.numerator).bit_length()
    if abs(value) * F(2)**shift >= 2**bits: shift -= 1
    return round(value * F(2)**shift) / F(2)**shift if value else value
@lru_cache(2**20)
def joined(a, b):  # polynomials are {((name, power), ..): coefficient}; values are fractions of them
    powers = dict(a)
    for name, n in b: powers[name] = powers.get(name, 0) + n
    return tuple(sorted(powers.items()))
def add(a, b, scale=1):
    total = dict(a)
    for m, k in b.items(): total[m] = total.get(m, 0) + scale * k
    return {m: k for m, k in total.items() if k}
def mul(a, b):
    total = {}
    for m, k in a.items():
        for n, l in b.items(): p = joined(m, n); total[p] = total.get(p, 0) + k * l
    return {m: k for m, k in total.items() if k}
def number(k): return ({(): k} if k else {}), ONE
def variable(name): return {((name, 1),): 1}, ONE
def plus(a, b, scale=1):
    return (add(a[0], b[0], scale), a[1]) if a[1] == b[1] else (add(mul(a[0], b[1]), mul(b[0], a[1]), scale), mul(a[1], b[1]))
def minus(a, b): return plus(a, b, -1)
def times(a, b): return (mul(a[0], b[0]), mul(a[1], b[1])) if a[1] != b[0] else (a[0], b[1])
def over(a, b):
    need(b[0], "a formula divides by zero")
    return (mul(a[0], {(): F(1) / b[0][()]}), a[1]) if set(b[0]) == {()} and b[1] == ONE else times(a, b[::-1])
def same(a, b): return a == b or not minus(a, b)[0]
ONE, OPERATORS = {(): 1}, {"Add": plus, "Sub": minus, "Mult": times, "Div": over}

class Formulas:
    """Values of expressions; functions are atoms: of equal arguments, one and the same. ``taken``: the case of a law."""
    def __init__(self, names, atoms, real="", meant=(), taken=None):
        self.names, self.atoms, self.real, self.meant, self.taken = names, atoms, real, meant, taken
    def parsed(self, text):
        need(text.isascii() and not re.search(r"//|\+\+|--|['\"\\#]" + r"|\*\*" * bool(self.real), text), f"no formula: {text[:60]}")
        return ast.parse(NUMBER.sub(r"'\1'", text).strip(), mode="eval").body
    def read(self, text): return self.value(self.parsed(text))
    def choice(self, text):
        match = need(CHOICE.fullmatch(text), f"expected a choice, got {text[:60]!r}")
        return match[2], *(self.read(match[i]) for i in (1, 3, 4, 5))
    def value(self, node):
        kind, operator = type(node).__name__, type(getattr(node, "op", None)).__name__
        if operator == "USub": return minus(number(0), self.value(node.operand))
        if operator == "Pow": return self.power(self.value(node.left), F(self.value(node.right)[0].get((), 0)))
        if operator in OPERATORS: return OPERATORS[operator](self.value(node.left), self.value(node.right))
        if kind == "Constant" and type(node.value) is (str if self.real else int): return self.constant(node.value)
        if kind in ("Name", "Subscript"): return self.named(ast.unparse(node))
        need(kind == "Call" and not node.keywords and isinstance(node.func, ast.Name), f"expected a formula, got {kind} {operator}")
        return self.call(node.func.id, node.args)
    def constant(self, literal):
        if not self.real: return number(literal)
        need(literal.endswith("f") == (self.real == "float"), f"expected a number of type {self.real}, got {literal}")
        value = nearest(F(literal.rstrip("f")), self.real)
        return self.meant[value] if value in self.meant else number(value)
    def named(self, name): return self.names[name] if name in self.names else need(self.taken is not None and variable(name), f"{name} has no value")
    def power(self, base, n):
        base, whole = self.function("sqrt", [base]) if n.denominator == 2 else base, number(1)
        for _ in range(need(n.denominator <= 2 and -99 < n < 99 and abs(n.numerator), f"not a power of formulas: {n}")): whole = times(whole, base)
        return whole if n > 0 else over(number(1), whole)
    def call(self, name, nodes):
        end = "f" if self.real == "float" else ""
        bare = {"fabs": "Abs"}.get(bare := name.removesuffix(end), bare.removeprefix("symrot_")) if self.real else name
        emitted = ("symrot_" if bare in SAFE else "") + {"Abs": "fabs"}.get(bare, bare) + end if self.real else bare
        need(ARITY.get(bare) == len(nodes) and name == emitted and (name[:7] != "symrot_" or name in self.names), f"not a function of kernels: {name}")
        return self.function(bare, [self.value(node) for node in nodes])
    def function(self, name, values):
        if self.taken is not None and name in EXPLICIT: return Formulas(dict(zip("xy", values)), self.atoms, taken=self.taken).read(EXPLICIT[name])
        for left, relation, right in self.taken or ():
            if name == "select_ge" and same(left, values[0]) and same(right, values[1]): return values[2 if relation == ">=" else 3]
        for known, of, value in self.atoms:
            if known == name and all(map(same, of, values)): return value
        self.atoms.append((name, values, variable(f"atom {len(self.atoms)}")))
        return self.atoms[-1][2]
    def run(self, body, inputs, targets=()):  # what statements of C assign to places, or the choice that they return
        found, (*statements, end) = {}, body.split(";")
        for at, statement in enumerate(statements, 1):
            silenced, target, formula, returned = need(STATEMENT.fullmatch(statement), f"not a statement: {statement[:60]}").groups()
            if returned: need(at == len(statements) and not end.strip(), "expected nothing after return"); return self.choice(returned)
            if silenced: need(silenced in inputs, f"expected an argument, got {silenced}"); continue
            const, real, name = target.split() if target.startswith("const ") else ("", "", target)
            new = real == self.real and name not in {*self.names, *inputs, *RESERVED} if const else name in targets and name not in found
            need(new, f"expected a new name, or an output once, got {target}")
            (self.names if const else found)[name] = self.read(formula)
        return need(not end.strip() and found, f"expected a statement, got {end[:60]!r}")

def prove(law, case, formulas):  # link 1, in one case: each entry, its outputs replaced, is a combination of relations
    reader = Formulas({}, [], taken=[])
    relations = [reader.read(text)[0] for text in law["given"]]
    def combined(value, factor, cofactors):
        total = number(0)
        for place, text in cofactors: total = plus(total, times(reader.read(text), (relations[place], ONE)))
        return reader.read(factor)[0] and same(times(value, reader.read(factor)), total)
    def positive(value): return all(k > 0 and all(n % 2 == 0 or least(v) for v, n in m) for part in value for m, k in part.items())
    def least(v): return any(x == variable(v) and (f == "sqrt" or f == "atan2" and positive(of[0])) for f, of, x in reader.atoms)
    for kind, *about in case["steps"]:
        texts = [f"({text})" for text in about[:2]]
        if kind == "name":
            need(re.fullmatch(r"g\d+_", about[0]) and about[0] not in reader.names, f"expected a new name, got {about[0]}")
            reader.names[about[0]] = reader.read(about[1])
        elif kind in RELATIONS: relations.append(reader.read(RELATIONS[kind].format(*texts))[0])
        elif kind == "square":
            square, value = map(reader.read, about[:2])
            need(positive(value) and combined(minus(square, times(value, value)), *about[2:]), f"{about[1]} is not the root of {about[0]}")
            reader.atoms.insert(0, ("sqrt", [square], value))
        else:
            sides = iter(FACTS[kind].format(*texts).split(" = "))
            for left, right in zip(sides, sides):
                node = reader.parsed(left)
                reader.atoms.append((node.func.id, [reader.value(each) for each in node.args], reader.read(right)))
    need(relations == [reader.read(text)[0] for text in case["relations"]], "expected the relations of the steps")
    reader.taken = [(reader.read(left), relation, reader.read(right)) for left, relation, right in case["case"]]
    for name, text in formulas: need(name not in reader.names, f"{name} is given twice"); reader.names[name] = reader.read(text)
    for text, entry in need(len(case["entries"]) == len(law["vanishing"]) and zip(law["vanishing"], case["entries"]), "a proof of each entry"):
        need(combined(reader.read(text), *entry), f"the law {law['law']!r} does not follow")
def complete(cases):  # whether cases are all there are: both ways of one choice, and so on
    if not cases or not cases[0]: return len(cases) == 1
    ways = [[case[1:] for case in cases if case and case[0] == [cases[0][0][0], way, cases[0][0][2]]] for way in ("<", ">=")]
    return len(cases) == sum(map(len, ways)) and all(map(complete, ways))

def safe(name, real, found, said):  # whether a static function is one of those that formulas call
    bare, (_, returns, arguments, body) = name.removeprefix("symrot_").removesuffix("f" if real == "float" else ""), found[name]
    names = [argument.removeprefix(f"{real} ") for argument in arguments.split(", ")]
    need(returns == real and len(names) == ARITY[bare] and all(map(str.isidentifier, names)), f"expected other arguments of {name}")
    wanted, atoms, own = SAFE[bare], [], {x: variable(x) for x in "xyzw"}
    if bare in TAYLOR:
        (split, terms, rest), = [(F(each[1]), each[2], F(each[3])) for each in said if each[0] == bare]
        falling = [abs(TAYLOR[bare](k)) * split**k for k in range(terms + 1)]
        need(sorted(falling, reverse=True) == falling and rest == falling[-1] / (falling[0] - falling[1]), f"the bound of the series of {bare}")
        wanted = wanted.format(split, " + ".join(f"({nearest(TAYLOR[bare](k), real)})" + f"*x**{2 * k}" * (k > 0) for k in range(terms)))
    reader = Formulas(dict(zip(names, own.values())), atoms, real)
    got, want = reader.run(body, names), Formulas(own, atoms).choice(wanted)
    need(got[0] == want[0] and all(map(same, got[1:], want[1:])), f"{name} is not {wanted}")

def near(text):  # a text of one sample as batches have it, where angles are in the range of symrot_math.h
    text = re.sub(r"\bsymrot_(sinc|sine_gap|tangent_gap)(f?)\(", r"symrot_near_\1\2(", text)
    return re.sub(r"(?<!\w)(sin|cos)(f?)\(", r"symrot_\1\2(", text)
def equal(name, data, found):  # link 3: a function, of one sample and of many, is the formulas
    said, formulas, places = data["readback"][name], {p: text for p, _, text in data["spec"]["formulas"]}, {p: s for p, s, *_ in data["inputs"]}
    real, end = said["type"], "f" if said["type"] == "float" else ""
    sizes = {place.partition("[")[0]: 0 for place in (*places, *formulas)}
    for place in (*places, *formulas): sizes[place.partition("[")[0]] += "[" in place
    const = {base: "" if f"{base}[0]" in formulas else "const " for base in sizes}
    one = {base: f"{const[base]}{real} {base}[{size}]" if size else f"{real} {base}" for base, size in sizes.items()}
    many = {base: one[base] if base == "p" else f"{const[base]}{real} *SYMROT_RESTRICT {base}" for base in sizes}
    _, returns, arguments, body = found[name]
    need((returns, arguments) == ("void", ", ".join(one.values())), f"expected other arguments of {name}")
    meant = {F(written): Formulas({"pi": variable("pi")}, []).read(text) for written, text in said["constants"]}
    for value, (above, below) in meant.items():
        exact = sum(k * (PI if m else 1) for m, k in above.items())
        need(below == ONE and set(above) <= {(), (("pi", 1),)} and nearest(exact, real) == value, f"{value} stands for something else")
    called, atoms = {f for f in found if found[f][0] and found[f][1] == real}, []
    for each in called:
        if not each.startswith("symrot_near_"): safe(each, real, found, said["series"])
        else: need(found[each][1:3] == found[each.replace("near_", "")][1:3] and found[each][3] == near(re.sub(
            r"return (\w+) (<|==) (.*?) \? (.*?) : (.*);", lambda m: f"return symrot_select_{'lt' if m[2] == '<' else 'eq'}{end}({', '.join(m.group(1, 3, 4, 5))});",
            found[each.replace("near_", "")][3])), f"{each} is another function")
    free = Formulas({}, atoms, taken=[])
    names = {place: free.read(data["spec"]["parameters"].get(symbol, symbol)) for place, symbol in places.items()}
    got = Formulas(names | dict.fromkeys(called), atoms, real, meant).run(body, {*sizes}, formulas)
    reader = Formulas({}, atoms, taken=None)
    reader.names = {s: variable(s) for s in re.findall(r"[A-Za-z_]\w*", " ".join([*places.values(), *data["spec"]["parameters"].values(), "pi"]))}
    for symbol, text in data["spec"]["named"]: reader.names[symbol] = reader.read(text)
    for place, text in formulas.items(): need(place in got and same(got[place], reader.read(text)), f"{place} of {name} is not {text}")
    silent, rest = re.fullmatch(r"((?: \(void\)\w+;)*)(.*)", body).groups()
    for base in reversed([base for base in sizes if not sizes[base] and re.search(rf"\b{base}\b", rest)]):
        rest = f" const {real} {base}_k = {base}[k];" + re.sub(rf"\b{base}\b", f"{base}_k", rest)
    rest = re.sub(r"\b(?!p\[)(\w+)\[(\d+)\]", r"\1[\2*n + k]", rest)
    _, returns, arguments, body = found[f"{name}_batch"]
    turning, asked = (re.findall(rf"{f}\(((?:[^()]|\([^()]*\))*)\)", body) for f in (r"symrot_(?:sin|cos|near_\w+?)f?", "symrot_farf?"))
    blocks = BLOCKS.format(silent, 32 if end else 64, near(rest), " + ".join(f"symrot_far{end}({each})" for each in asked), rest)
    need((returns, arguments) == ("void", ", ".join(["size_t n", *many.values()])), f"expected other arguments of {name}_batch")
    need(body == LOOP.format(silent, rest) or body == blocks and set(turning) <= set(asked), f"{name}_batch does not compute what {name} does")

def check(path):  # what a certificate shows, in a line; an error with a sentence if it does not
    path, found = Path(path), {}
    data = json.loads(path.read_bytes())
    need(isinstance(data, dict) and data.get("schema") == "symrot.certificate/1", "expected the schema symrot.certificate/1")
    bare = json.dumps({key: each for key, each in data.items() if key != "seal"}, sort_keys=True, separators=(",", ":"))
    name = need(hashlib.sha256(bare.encode()).hexdigest() == data["seal"] and data["kernel"], "the certificate is not as it was printed")
    need(path.name == f"{name}.cert.json" and {f"{name}.c", f"{name}.h"} <= {*data["files"]}, "the certificate is that of another file")
    for file, digest in data["files"].items():
        if not file.startswith("../") or (path.parent / file).exists(): need(hashlib.sha256((path.parent / file).read_bytes()).hexdigest() == digest, f"{file} is not the file that was certified")
    text = (path.parent / f"{name}.c").read_text("utf-8")
    need(not re.search(r"\\|\?\?|[\0-\x09\x0b-\x1f]", text), "expected no backslash, trigraph or control character")
    lines = re.sub(r"/\*.*?\*/", " ", text, flags=re.S).split("\n")
    own = [line for line in lines if line.strip() not in ("#include <math.h>", '#include "symrot_math.h"', f'#include "{name}.h"')]
    for chunk in re.split(r"^\}$", "\n".join(own), flags=re.M)[:-1]:
        static, returns, called, *rest = need(HEAD.fullmatch(" ".join(chunk.split()) + " "), f"expected a function, got {chunk.strip()[:60]!r}").groups()
        need(called not in found and (not static or called.startswith("symrot_")), f"expected one definition of {called}")
        found[called] = static, returns, *rest
    need(not own[-1].strip() and {f for f in found if not found[f][0]} == {f + end for f in data["readback"] for end in ("", "_batch")}, "expected other functions")
    for each in data["readback"]: equal(each, data, found)
    formulas = [*data["spec"]["named"], *(item[1:] for item in data["spec"]["formulas"])]
    for law in data["laws"]:
        need(complete([case["case"] for case in law["cases"]]), f"expected every case of the law {law['law']!r}")
        for case in law["cases"]: prove(law, case, formulas)
    return f"{name}: {len(data['files'])} hashes, C text = formulas for {', '.join(data['readback'])} and batches, {len(data['laws'])} laws: they hold"

REFUSALS = (LookupError, TypeError, AttributeError, SyntaxError, MemoryError, RecursionError, ValueError, ArithmeticError, OSError)
def sentence(reason): return str(reason) if isinstance(reason, (ValueError, OSError)) else f"expected a certificate of the schema ({reason!r})"
if __name__ == "__main__":
    for path in sys.argv[1:] or sys.exit("usage: python recheck.py NAME.cert.json .."):
        try: print(check(path))
        except REFUSALS as reason: sys.exit(f"{path}: {sentence(reason)}")
