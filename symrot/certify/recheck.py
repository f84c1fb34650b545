"""Re-verify kernels from their files alone: `python recheck.py NAME.cert.json ..`; standard library, nothing of symrot.

Every hash; link 3, that the C text is its formulas, exactly; link 1, that the formulas obey their laws. Exit 0 and a
line for each certificate that holds, exit 1 and a sentence for the first that does not. It trusts Python and itself.
"""
# ruff: noqa: E401, E701, E702
# fmt: off
import ast, hashlib, json, re, sys
from fractions import Fraction as F
from functools import lru_cache
from math import factorial
from pathlib import Path

NUMBER = re.compile(r"(?<![\w.])(\d+\.\d*(?:e[-+]?\d{1,3})?f?|\d+e[-+]?\d{1,3}f?)(?![\w.])")
FUNCTION = re.compile(r"(static inline |)(void|double|float) (\w+)\( ?([^()]*)\) \{((?:[^{}]|\{[^{}]*\})*)\} ?", re.A)
PARAMETER = re.compile(r"(const |)(double|float|size_t) (\*SYMROT_RESTRICT |)(\w+)(\[\d+\]|)", re.A)
STATEMENT = re.compile(r" ?(?:\(void\)(\w+)|(const \w+ \w+|\w+\[[^][]*\]) = ([^=]*)|return (.*))", re.A)
CHOICE = re.compile(r"([^?:<>=]*)(<|>=|==)([^?:<>=]*)\?([^?:<>=]*):([^?:<>=]*)")
LOOP = re.compile(r"((?: \(void\)\w+;)*) for \(size_t k = 0; k < n; \+\+k\) \{(.*)\} ", re.A)
EXPLICIT = dict(sinc="sin(x)/x", arc_ratio="atan2(x, y)/x", sine_gap="(x - sin(x))/x**3", tangent_gap="(sin(x) - x*cos(x))/x**3", Abs="copysign(1, x)*x")
TAYLOR = dict(sine_gap=lambda k: F((-1)**k, factorial(2*k + 3)), tangent_gap=lambda k: F((-1)**k * (2*k + 2), factorial(2*k + 3)))
SAFE = dict(select_ge="x >= y ? z : w", sinc="x == 0 ? 1 : sin(x)/x", arc_ratio="x == 0 ? 1/y : atan2(x, y)/x",
            **{name: f"x*x < {{}} ? {{}} : {EXPLICIT[name]}" for name in TAYLOR})
ARITY = dict.fromkeys("sin cos tan asin acos atan exp log sinh cosh tanh sqrt Abs sinc sine_gap tangent_gap".split(), 1) | dict(
    atan2=2, copysign=2, arc_ratio=2, select_ge=4)
FACTS = {  # what functions are, whatever the arguments: left, right, left, right
    "sum": ("sin({0} + {1})", "sin({0})*cos({1}) + cos({0})*sin({1})", "cos({0} + {1})", "cos({0})*cos({1}) - sin({0})*sin({1})"),
    "odd": ("sin(-{0})", "-sin({0})", "cos(-{0})", "cos({0})"),
    "quarter": ("sin({0} + pi/2)", "cos({0})", "cos({0} + pi/2)", "-sin({0})"),
    "quarter back": ("sin({0} - pi/2)", "-cos({0})", "cos({0} - pi/2)", "sin({0})"),
    "arc": ("sin(atan2({0}, {1}))", "{0}/sqrt({0}**2 + {1}**2)", "cos(atan2({0}, {1}))", "{1}/sqrt({0}**2 + {1}**2)"),
    "wrap": tuple(text.replace("W", "select_ge(pi, {0}, select_ge({0}, -pi, {0}, {0} + 2*pi), {0} - 2*pi)") for text in ("sin(W)", "sin({0})", "cos(W)", "cos({0})"))}
RELATIONS = dict(circle="sin({0})**2 + cos({0})**2 - 1", root="sqrt({0})**2 - {0}", sign="copysign(1, {0})**2 - 1")  # what vanishes
PI = sum(F(k * (-1) ** n, (2 * n + 1) * d ** (2 * n + 1)) for k, d in ((16, 5), (-4, 239)) for n in range(60))  # Machin

def need(holds, said):
    if not holds: raise ValueError(said)
    return holds
def nearest(value, real):  # number of the type nearest to a value, ties to even
    bits = {"double": 53, "float": 24}[real]
    shift = bits + value.denominator.bit_length() - abs(value.numerator).bit_length()
    if abs(value) * F(2) ** shift >= 2**bits: shift -= 1
    return round(value * F(2) ** shift) / F(2) ** shift if value else value
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
def over(a, b): return (mul(a[0], {(): F(1) / b[0][()]}), a[1]) if b[0].keys() == {()} and b[1] == ONE else times(a, (b[1], need(b[0], "a formula divides by zero")))
def same(a, b): return a == b or not minus(a, b)[0]
ONE, OPERATORS = {(): 1}, {"Add": plus, "Sub": minus, "Mult": times, "Div": over}

class Formulas:
    """Values of expressions; functions are atoms: of equal arguments, one and the same. ``taken``: the case of a law."""
    def __init__(self, names, atoms, real="", meant=(), taken=None): self.names, self.atoms, self.real, self.meant, self.taken = names, atoms, real, meant, taken
    def read(self, text): return self.value(self.parsed(text))
    def parsed(self, text):
        need(text.isascii() and not re.search(r"//|\+\+|--|['\"\\#]" + r"|\*\*" * bool(self.real), text), f"expected a formula, got {text[:60]!r}")
        return ast.parse(NUMBER.sub(r"'\1'", text).strip(), mode="eval").body
    def choice(self, text):
        match = need(CHOICE.fullmatch(text), f"expected a choice, got {text[:60]!r}")
        return match[2], *(self.read(match[i]) for i in (1, 3, 4, 5))
    def value(self, node):
        kind, operator = type(node).__name__, type(getattr(node, "op", None)).__name__
        if kind == "BinOp" and operator == "Pow": return self.power(self.value(node.left), F(self.value(node.right)[0].get((), 0)))
        if kind == "BinOp" and operator in OPERATORS: return OPERATORS[operator](self.value(node.left), self.value(node.right))
        if operator == "USub": return minus(number(0), self.value(node.operand))
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
        for _ in range(need(abs(n) < 99 and n.denominator <= 2 and abs(n.numerator), f"expected a power below 99, got {n}")): whole = times(whole, base)
        return whole if n > 0 else over(number(1), whole)
    def call(self, name, nodes):
        bare = name.removesuffix("f") if self.real == "float" else name
        bare = ("Abs" if bare == "fabs" else bare.removeprefix("symrot_")) if self.real else bare
        emitted = ("symrot_" if bare in SAFE else "") + {"Abs": "fabs"}.get(bare, bare) + ("f" if self.real == "float" else "")
        need(ARITY.get(bare) == len(nodes) and name == (emitted if self.real else bare) and (not self.real or bare not in SAFE or name in self.names), f"expected a function that kernels call, got {name}")
        return self.function(bare, [self.value(node) for node in nodes])
    def function(self, name, values):
        if self.taken is not None and name in EXPLICIT: return Formulas(dict(zip("xy", values)), self.atoms, taken=self.taken).read(EXPLICIT[name])
        for left, relation, right in self.taken or ():
            if name == "select_ge" and same(left, values[0]) and same(right, values[1]): return values[2 if relation == ">=" else 3]
        for known, of, value in self.atoms:
            if known == name and all(map(same, of, values)): return value
        self.atoms.append((name, values, variable(f"atom {len(self.atoms)}")))
        return self.atoms[-1][2]
    def run(self, body, inputs, targets=()):
        """What statements of C assign to places, or the choice that they return."""
        found, (*statements, end) = {}, body.split(";")
        need(not end.strip(), f"expected a statement, got {end[:60]!r}")
        for at, statement in enumerate(statements, 1):
            silenced, target, formula, returned = need(STATEMENT.fullmatch(statement), f"expected a statement, got {statement[:60]!r}").groups()
            if returned: need(at == len(statements), "expected nothing after return"); return self.choice(returned)
            if silenced: need(silenced in inputs, f"expected an argument, got {silenced}"); continue
            const, real, name = target.split() if target.startswith("const ") else ("", "", ast.unparse(self.parsed(target)))
            need(real == self.real and name not in {*self.names, *inputs, "n", "k"} if const else name in targets and targets[name] not in found, f"expected to assign a new name or an output once, got {target}")
            (self.names if const else found)[name if const else targets[name]] = self.read(formula)
        return found

def prove(law, case, formulas):
    """Link 1, in one case of a law: each entry, its outputs replaced by their formulas, is a combination of relations."""
    reader = Formulas({}, [], taken=[])
    relations = [reader.read(text)[0] for text in law["given"]]
    def combined(value, factor, cofactors):
        total = number(0)
        for place, text in cofactors: total = plus(total, times(reader.read(text), (relations[place], ONE)))
        return reader.read(factor)[0] and same(times(value, reader.read(factor)), total)
    def positive(value): return all(k > 0 and all(n % 2 == 0 or least(name) for name, n in m) for part in value for m, k in part.items())
    def least(name): return any(atom == variable(name) and (kind == "sqrt" or kind == "atan2" and positive(of[0])) for kind, of, atom in reader.atoms)
    for kind, *about in case["steps"]:
        texts = [f"({text})" for text in about[:2]]
        if kind == "name":
            need(re.fullmatch(r"g\d+_", about[0]) and about[0] not in reader.names, f"expected a new name, got {about[0]}")
            reader.names[about[0]] = reader.read(about[1])
        elif kind in RELATIONS: relations.append(reader.read(RELATIONS[kind].format(*texts))[0])
        elif kind == "square":
            square, value = map(reader.read, about[:2])
            need(positive(value) and combined(minus(square, times(value, value)), *about[2:]), f"expected {about[1]} to be the root of {about[0]}")
            reader.atoms.insert(0, ("sqrt", [square], value))
        else:
            for left, right in zip(*[iter(text.format(*texts) for text in FACTS[kind])] * 2):
                node = reader.parsed(left)
                reader.atoms.append((node.func.id, [reader.value(each) for each in node.args], reader.read(right)))
    need(relations == [reader.read(text)[0] for text in case["relations"]], "expected the relations of the steps")
    reader.taken = [(reader.read(left), relation, reader.read(right)) for left, relation, right in case["case"]]
    for name, text in formulas: need(name not in reader.names, f"{name} is given twice"); reader.names[name] = reader.read(text)
    need(len(case["entries"]) == len(law["vanishing"]), "expected a proof of each entry")
    for text, (factor, cofactors) in zip(law["vanishing"], case["entries"]):
        need(combined(reader.read(text), factor, cofactors), f"the law {law['law']!r} does not follow")

def complete(cases):  # whether cases are all there are: both ways of one choice, and so on
    if not cases or not cases[0]: return len(cases) == 1
    (left, _, right), ways = cases[0][0], {way: [c[1:] for c in cases if c and c[0][1] == way] for way in ("<", ">=")}
    return all(c and [c[0][0], c[0][2]] == [left, right] for c in cases) and len(cases) == sum(map(len, ways.values())) and all(map(complete, ways.values()))

def functions(text, name):
    """The functions of a C file: name -> (whether static, what it returns, its parameters, its body)."""
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    lines = [line for line in text.split("\n") if line.strip() not in ("#include <math.h>", f'#include "{name}.h"')]
    text, found, at = " ".join(" ".join(lines).split()), {}, 0
    while at < len(text):
        match = need(FUNCTION.match(text, at), f"expected a function as symrot emits it, got {text[at:at + 60]!r}")
        need(match[3] not in found, f"expected one definition of {match[3]}"); at = match.end()
        found[match[3]] = match[1], match[2], [need(PARAMETER.fullmatch(p), f"expected a parameter, got {p}").groups() for p in match[4].split(", ")], match[5]
    return found

def equal(name, certificate, found, formulas, places):
    """Link 3: both functions of one type, one sample and batch, are the formulas; how, is said in the read-back."""
    said = certificate["readback"][name]
    real, series = said["type"], {text: (F(split), terms, F(rest)) for text, split, terms, rest in said["series"]}
    meant = {F(written): Formulas({"pi": variable("pi")}, []).read(text) for written, text in said["constants"]}
    for value, (above, below) in meant.items(): need(nearest(sum(k * (PI if m else 1) for m, k in above.items()), real) == value and below == ONE and set(above) <= {(), (("pi", 1),)}, f"{float(value)} stands for something else")
    for called, (static, returns, parameters, body) in found.items():
        if static and returns == real:
            safe, args = called.removeprefix("symrot_").removesuffix("f" if real == "float" else ""), {p[3]: variable(x) for p, x in zip(parameters, "xyzw")}
            need([p[:3] + p[4:] for p in parameters] == [("", real, "", "")] * ARITY[safe], f"expected other parameters for {called}")
            wanted, atoms = SAFE[safe], []
            if safe in TAYLOR:
                split, terms, rest = series.pop(safe); falling = [abs(TAYLOR[safe](k)) * split**k for k in range(terms + 1)]
                need(sorted(falling, reverse=True) == falling and rest == falling[-1] / (falling[0] - falling[1]), f"expected the bound of the series of {safe}")
                wanted = wanted.format(split, " + ".join(f"({nearest(TAYLOR[safe](k), real)})" + f"*x**{2 * k}" * (k > 0) for k in range(terms)))
            got, want = Formulas(args, atoms, real).run(body, args), Formulas(args | {x: variable(x) for x in "xyzw"}, atoms).choice(wanted)
            need(got[0] == want[0] and all(map(same, got[1:], want[1:])), f"{called} is not {wanted}")
    need(not series, "expected no other series")
    for suffix in ("", "_batch"):
        _, returns, parameters, body = need(found.get(name + suffix), f"expected a function {name + suffix}")
        need(returns == "void" and (parameters.pop(0)[1:4:2] == ("size_t", "n") if suffix else True) and all(p[1] == real for p in parameters), f"expected other parameters for {name + suffix}")
        inputs, targets, atoms = {}, {}, []
        for const, _, pointer, given, size in parameters:
            for place in (place for place in (*places, *formulas) if place.partition("[")[0] == given):
                index = place.partition("[")[2][:-1]
                need((place in places) == bool(const or place == given) and bool(pointer) <= bool(suffix), f"expected another parameter than {given}")
                (inputs if place in places else targets)[(f"{given}[{index} * n + k]" if index else f"{given}[k]") if pointer else place] = place
            need(pointer or not size or size == f"[{sum(p.partition('[')[0] == given for p in (*places, *formulas))}]", f"expected another size of {given}")
        if suffix:
            silenced, body = need(LOOP.fullmatch(body), "expected one loop over all samples").groups()
            need(all(each.strip()[6:] in {p[3] for p in parameters} for each in silenced.split(";")[:-1]), "expected arguments after (void)")
        names = {read: variable(places[place]) for read, place in inputs.items()} | {called: () for called in found if found[called][0]}
        got = Formulas(names, atoms, real, meant).run(body, {p[3] for p in parameters}, targets)
        reader = Formulas({symbol: variable(symbol) for symbol in ("pi", *places.values())}, atoms)
        for symbol, text in certificate["spec"]["named"]: reader.names[symbol] = reader.read(text)
        for place, text in formulas.items(): need(place in got and same(got[place], reader.read(text)), f"{place} of {name + suffix} is not {text}")

def check(path):
    """What a certificate shows, in a line; ValueError with a sentence if it does not."""
    path = Path(path)
    data = json.loads(path.read_bytes())
    need(isinstance(data, dict) and data.get("schema") == "symrot.certificate/1", "expected the schema symrot.certificate/1")
    seal = hashlib.sha256(json.dumps({k: v for k, v in data.items() if k != "seal"}, sort_keys=True, separators=(",", ":")).encode()).hexdigest()
    name = data["kernel"]
    need(seal == data["seal"] and path.name == f"{name}.cert.json", "the certificate is not as it was printed, or of another file")
    for file, digest in data["files"].items():
        place = path.parent / file
        need(hashlib.sha256(place.read_bytes()).hexdigest() == digest, f"{file} is not the file that was certified")
    text, header = ((path.parent / f"{name}{end}").read_text("utf-8") for end in (".c", ".h"))
    need(not re.search(r"\\|\?\?|[\0-\x09\x0b-\x1f]", text + header), "expected no backslash, trigraph or control character")
    found = functions(text, name)
    places = {place: symbol for place, symbol, _ in data["inputs"]}
    need({f for f in found if not found[f][0]} == {f + end for f in data["readback"] for end in ("", "_batch")}, "expected the functions of the certificate")
    for each in data["readback"]: equal(each, data, found, {p: t for p, _, t in data["spec"]["formulas"]}, places)
    formulas = [*data["spec"]["named"], *((symbol, text) for _, symbol, text in data["spec"]["formulas"])]
    for law in data["laws"]:
        need(complete([case["case"] for case in law["cases"]]), f"expected every case of the law {law['law']!r}")
        for case in law["cases"]: prove(law, case, formulas)
    return f"{name}: C text = formulas ({len(data['readback'])} types, one sample and batch), {len(data['laws'])} laws of the formulas, {len(data['files'])} hashes: they hold"

if __name__ == "__main__":
    for path in sys.argv[1:] or ["(no certificate)"]:
        try: print(check(path))
        except (ValueError, KeyError, TypeError, IndexError, AttributeError, SyntaxError, ArithmeticError, RecursionError, OSError) as reason:
            sys.exit(f"{path}: {type(reason).__name__ if not isinstance(reason, ValueError) else 'refused'}: {reason}")
