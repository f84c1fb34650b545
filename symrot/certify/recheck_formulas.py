"""Exact arithmetic of formulas and of their laws, for recheck.py: standard library, nothing of symrot.

Expressions, of formulas and of emitted C, become fractions of polynomials over names and atoms: values of functions."""

# ruff: noqa
# mypy: ignore-errors
# fmt: off
import ast, re
from fractions import Fraction as F
from functools import lru_cache
from math import factorial

NUMBER = re.compile(r"(?<![\w.])(\d+\.\d*(?:e[-+]?\d{1,3})?f?|\d+e[-+]?\d{1,3}f?)(?![\w.])")
STATEMENT = re.compile(r" (?:\(void\)(\w+)|(const \w+ \w+|\w+\[\d+\]) = ([^=]*)|return (.*))", re.A)
CHOICE = re.compile(r"([^?:<>=]*)(<|>=|==)([^?:<>=]*)\?([^?:<>=]*):([^?:<>=]*)")
EXPLICIT = dict(sinc="sin(x)/x", arc_ratio="atan2(x, y)/x", sine_gap="(x - sin(x))/x**3",
                tangent_gap="(sin(x) - x*cos(x))/x**3", Abs="copysign(1, x)*x")
TAYLOR = dict(sine_gap=lambda k: F((-1)**k, factorial(2*k + 3)),  # of x^(2 k)
              tangent_gap=lambda k: F((-1)**k * (2*k + 2), factorial(2*k + 3)))
SAFE = dict(select_ge="x >= y ? z : w", sinc="x == 0 ? 1 : sin(x)/x", arc_ratio="x == 0 ? 1/y : atan2(x, y)/x",
            **{name: f"x*x < {{}} ? {{}} : {EXPLICIT[name]}" for name in TAYLOR})
ARITY = dict.fromkeys("sin cos tan asin acos atan exp log sinh cosh tanh sqrt Abs sinc sine_gap tangent_gap".split(), 1)
ARITY |= dict(atan2=2, copysign=2, arc_ratio=2, select_ge=4)
FACTS = {  # what functions are, whatever the arguments: left = right = left = right
    "sum": "sin({0} + {1}) = sin({0})*cos({1}) + cos({0})*sin({1}) = "
           "cos({0} + {1}) = cos({0})*cos({1}) - sin({0})*sin({1})",
    "odd": "sin(-{0}) = -sin({0}) = cos(-{0}) = cos({0})",
    "quarter": "sin({0} + pi/2) = cos({0}) = cos({0} + pi/2) = -sin({0})",
    "quarter back": "sin({0} - pi/2) = -cos({0}) = cos({0} - pi/2) = sin({0})",
    "arc": "sin(atan2({0}, {1})) = {0}/sqrt({0}**2 + {1}**2) = cos(atan2({0}, {1})) = {1}/sqrt({0}**2 + {1}**2)",
    "wrap": "sin(W) = sin({0}) = cos(W) = cos({0})".replace(
        "W", "select_ge(pi, {0}, select_ge({0}, -pi, {0}, {0} + 2*pi), {0} - 2*pi)")}
RELATIONS = dict(circle="sin({0})**2 + cos({0})**2 - 1", root="sqrt({0})**2 - {0}", sign="copysign(1, {0})**2 - 1")

def need(holds, said): return holds or (_ for _ in ()).throw(ValueError(said))
def nearest(value, real):  # number of the type nearest to a value, ties to even
    bits, shift = {"double": 53, "float": 24}[real], value.denominator.bit_length() - abs(value.numerator).bit_length()
    scale = F(2)**(bits + shift - (abs(value) * F(2)**shift >= 1))
    return round(value * scale) / scale
# Polynomials are {((name, power), ..): coefficient}; values are fractions of two of them.
@lru_cache(2**20)
def joined(a, b):
    powers = dict(a)
    for name, n in b: powers[name] = powers.get(name, 0) + n
    return tuple(sorted(powers.items()))
def total(terms):
    found = {}
    for m, k in terms: found[m] = found.get(m, 0) + k
    return {m: k for m, k in found.items() if k}
def add(a, b, scale=1): return total([*a.items(), *((m, scale * k) for m, k in b.items())])
def mul(a, b): return total((joined(m, n), k * l) for m, k in a.items() for n, l in b.items())
def number(k): return ({(): k} if k else {}), ONE
def variable(name): return {((name, 1),): 1}, ONE
def plus(a, b, scale=1):
    if a[1] == b[1]: return add(a[0], b[0], scale), a[1]
    return add(mul(a[0], b[1]), mul(b[0], a[1]), scale), mul(a[1], b[1])
def minus(a, b): return plus(a, b, -1)
def times(a, b): return (mul(a[0], b[0]), mul(a[1], b[1])) if a[1] != b[0] else (a[0], b[1])
def over(a, b):
    constant = set(need(b[0], "a division by zero")) == {()} and b[1] == ONE
    return (mul(a[0], {(): F(1) / b[0][()]}), a[1]) if constant else times(a, b[::-1])
def same(a, b): return a == b or not minus(a, b)[0]
ONE, OPERATORS = {(): 1}, {"Add": plus, "Sub": minus, "Mult": times, "Div": over}

class Formulas:
    """Values of expressions; functions are atoms: of equal arguments, one and the same. ``taken``: the case of a law."""
    def __init__(self, names, atoms, real="", meant=(), taken=None):
        self.names, self.atoms, self.real, self.meant, self.taken = names, atoms, real, meant, taken
    def parsed(self, text):
        odd = re.search(r"//|\+\+|--|['\"\\#]" + r"|\*\*" * bool(self.real), text) or not text.isascii()
        return ast.parse(NUMBER.sub(r"'\1'", need(not odd and text.strip(), f"no formula: {text[:60]!r}")), mode="eval").body
    def read(self, text): return self.value(self.parsed(text))
    def choice(self, text):
        match = need(CHOICE.fullmatch(text), f"no choice: {text[:60]!r}")
        return match[2], [self.read(match[i]) for i in (1, 3, 4, 5)]
    def value(self, node):
        kind, operator = type(node).__name__, type(getattr(node, "op", None)).__name__
        if operator == "USub": return minus(number(0), self.value(node.operand))
        if operator == "Pow": return self.power(self.value(node.left), F(self.value(node.right)[0].get((), 0)))
        if operator in OPERATORS: return OPERATORS[operator](self.value(node.left), self.value(node.right))
        if kind == "Constant" and type(node.value) is (str if self.real else int): return self.constant(node.value)
        if kind in ("Name", "Subscript"): return self.names.get(ast.unparse(node)) or need(
            self.taken is not None and variable(ast.unparse(node)), f"{ast.unparse(node)} has no value")
        need(kind == "Call" and not node.keywords, f"no formula: {kind} {operator}")
        name, end, own = node.func.id, "f" if self.real == "float" else "", self.real and node.func.id.startswith("symrot_")
        bare = {"fabs": "Abs"}.get(b := name.removesuffix(end), b.removeprefix("symrot_")) if self.real else name
        right = "symrot_" * (bare in SAFE) + {"Abs": "fabs"}.get(bare, bare) + end if self.real else bare
        need(ARITY.get(bare) == len(node.args) and name == right and (not own or name in self.names), f"no function of kernels: {name}")
        return self.function(bare, [self.value(each) for each in node.args])
    def constant(self, literal):
        if not self.real: return number(literal)
        value = F(need(literal.endswith("f") == (self.real == "float") and literal.rstrip("f"), f"{literal} is no {self.real}"))
        value = value and nearest(value, self.real)
        return self.meant[value] if value in self.meant else number(value)
    def power(self, base, n):
        base, whole = self.function("sqrt", [base]) if n.denominator == 2 else base, number(1)
        for _ in range(need(n.denominator < 3 and abs(n) < 99 and abs(n.numerator), f"no power: {n}")): whole = times(whole, base)
        return whole if n > 0 else over(number(1), whole)
    def function(self, name, values):
        if self.taken is not None and name in EXPLICIT:
            return Formulas(dict(zip("xy", values)), self.atoms, taken=self.taken).read(EXPLICIT[name])
        for left, way, right in (self.taken or ()) if name == "select_ge" else ():
            if same(left, values[0]) and same(right, values[1]): return values[2 if way == ">=" else 3]
        for known, of, value in self.atoms:
            if known == name and all(map(same, of, values)): return value
        self.atoms.append((name, values, variable(f"atom {len(self.atoms)}")))
        return self.atoms[-1][2]
    def run(self, body, arguments, targets=()):  # what statements of C assign to places, or the choice that they return
        found, (*statements, end) = {}, body.split(";")
        for at, text in enumerate(need(not end.strip() and statements, f"no statement: {end[:60]!r}"), 1):
            silenced, target, formula, returned = need(STATEMENT.fullmatch(text), f"no statement: {text[:60]!r}").groups()
            if returned: return need(at == len(statements), "something after return") and self.choice(returned)
            if silenced: need(silenced in arguments, f"{silenced} is no argument"); continue
            const, real, name = target.split() if target.startswith("const ") else ("", "", target)
            taken = {*self.names, *arguments, "n", "k", "start", "end", "again", "beyond"}
            need(real == self.real and name not in taken if const else name in targets and name not in found, f"{target} is assigned")
            (self.names if const else found)[name] = self.read(formula)
        return found

def prove(law, case, formulas):
    """Link 1, in one case of a law: each entry, its outputs replaced, is a combination of the relations."""
    reader = Formulas({}, [], taken=[])
    relations = [reader.read(text)[0] for text in law["given"]]
    def combined(value, factor, cofactors):
        total, factor = number(0), reader.read(factor)
        for place, text in cofactors: total = plus(total, times(reader.read(text), (relations[place], ONE)))
        return factor[0] and same(times(value, factor), total)
    def positive(value):
        return all(k > 0 and all(n % 2 == 0 or least(v) for v, n in m) for part in value for m, k in part.items())
    def least(v):
        return any(x == variable(v) and (f == "sqrt" or f == "atan2" and positive(of[0])) for f, of, x in reader.atoms)
    for kind, *about in case["steps"]:
        texts = [f"({text})" for text in about[:2]]
        if kind == "name":
            need(re.fullmatch(r"g\d+_", about[0]) and about[0] not in reader.names, f"{about[0]} is no new name")
            reader.names[about[0]] = reader.read(about[1])
        elif kind in RELATIONS: relations.append(reader.read(RELATIONS[kind].format(*texts))[0])
        elif kind == "square":
            square, value = map(reader.read, about[:2])
            holds = positive(value) and combined(minus(square, times(value, value)), *about[2:])
            reader.atoms.insert(0, ("sqrt", [need(holds, f"{about[1]} is not the root of {about[0]}") and square], value))
        else:
            sides = iter(FACTS[kind].format(*texts).split(" = "))
            for left, right in zip(sides, sides):
                node = reader.parsed(left)
                reader.atoms.append((node.func.id, [reader.value(each) for each in node.args], reader.read(right)))
    need(relations == [reader.read(text)[0] for text in case["relations"]], "the relations are not those of the steps")
    reader.taken = [(reader.read(left), way, reader.read(right)) for left, way, right in case["case"]]
    for name, text in formulas:
        need(name not in reader.names and name.isidentifier() and not re.fullmatch(r"g\d+_|pi", name), f"{name} is no new name")
        reader.names[name] = reader.read(text)
    need(len(case["entries"]) == len(law["vanishing"]), f"the law {law['law']!r} has other entries")
    for text, entry in zip(law["vanishing"], case["entries"]):
        need(combined(reader.read(text), *entry), f"the law {law['law']!r} does not follow")

def complete(cases):
    """Whether cases are all there are: both ways of one choice, and so on."""
    if not cases or not cases[0]: return len(cases) == 1
    left, _, right = cases[0][0]
    ways = [[case[1:] for case in cases if case and case[0] == [left, way, right]] for way in ("<", ">=")]
    return len(cases) == sum(map(len, ways)) and all(map(complete, ways))
