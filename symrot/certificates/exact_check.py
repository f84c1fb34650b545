"""An exact check of certificates from their files alone; ``symrot audit`` begins with it.

It checks every hash, that the C text computes the formulas, and that the formulas obey their laws. It evaluates both
sides of each equation in exact arithmetic, where each variable and function value is a random integer of 128 bits.
"""

import ast
import math
import operator
import re
import secrets
from collections import defaultdict
from fractions import Fraction
from pathlib import Path

from symrot.certificates import recheck

# ruff: noqa: B905
# mypy: ignore-errors
HEAD = re.compile(r"(static inline |)(void|double|float) (\w+)\( ?([^()]*)\) \{(.*)", re.A)
STATEMENT = re.compile(r" (?:\(void\)\w+|const (\w+) (\w+) = ([^=]+)|(\w+\[[^]=]+\]) = ([^=]+)|return (.+))", re.A)
CHOICE = re.compile(r"([^?:<>=]+) (<|>=|==) ([^?:<>=]+) \? ([^?:<>=]+) : ([^?:<>=]+)")
NUMBER = re.compile(r"(?<![\w.])(\d+\.\d*(?:e[-+]?\d{1,3})?f?|\d+e[-+]?\d{1,3}f?)(?![\w.])")
(
    LOOP,
    BLOCKS,
    PARTS,
) = (  # forms of a batch: one loop; blocks, computed again for large angles; two loops over each block
    re.compile(r"(?: \(void\)\w+;)*" + re.escape(text).replace("@", "([^{}]*)"))
    for text in (
        " SYMROT_INDEPENDENT for (size_t k = 0; k < n; ++k) {@} ",
        " for (size_t start = 0; start < n; start += SYMROT_BLOCK) { const size_t end = n - start < SYMROT_BLOCK ? n : "
        "start + SYMROT_BLOCK; uint@_t beyond = 0; SYMROT_INDEPENDENT for (size_t k = start; k < end; ++k) {@ "
        "beyond += @; } const size_t again = beyond == 0 ? start : end; for (size_t k = start; k < again; ++k) {@} } ",
        " for (size_t start = 0; start < n; start += SYMROT_SPAN) { const size_t end = n - start < SYMROT_SPAN ? n : "
        "start + SYMROT_SPAN; SYMROT_INDEPENDENT for (size_t k = start; k < end; ++k) {@} SYMROT_INDEPENDENT for "
        "(size_t k = start; k < end; ++k) {@} } ",
    )
)
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}
CHOICES = {ast.Lt: "select_lt", ast.Eq: "select_eq", ast.GtE: "select_ge"}
MATH = ["sin", "cos", "tan", "asin", "acos", "atan", "exp", "log", "sinh", "cosh", "tanh", "sqrt", "atan2", "copysign"]
SAFE = {  # function of emitted C files, without the prefix symrot_ -> its formula, and its value in an exceptional case
    "sinc": ("sin(x)/x", "1 if x == 0"),
    "arc_ratio": ("atan2(x, y)/x", "1/y if x == 0"),
    "sine_gap": ("(x - sin(x))/x**3", "{series} if x*x < {split}"),
    "tangent_gap": ("(sin(x) - x*cos(x))/x**3", "{series} if x*x < {split}"),
    "sine_bend": ("(2*x + x*cos(x) - 3*sin(x))/x**5", "{series} if x*x < {split}"),
    "tangent_bend": ("((3 - x**2)*sin(x) - 3*x*cos(x))/x**5", "{series} if x*x < {split}"),
    "select_ge": ("w", "z if x >= y"),
}
TAYLOR = {  # coefficient of (-1)^k x^(2 k)
    "sine_gap": lambda k: Fraction(1, math.factorial(2 * k + 3)),
    "tangent_gap": lambda k: Fraction(2 * k + 2, math.factorial(2 * k + 3)),
    "sine_bend": lambda k: Fraction(2 * k + 2, math.factorial(2 * k + 5)),
    "tangent_bend": lambda k: Fraction(4 * (k + 1) * (k + 2), math.factorial(2 * k + 5)),
}
FACTS = {  # name -> two identities of functions, written as left = right = left = right
    "sum": "sin(X + Y) = sin(X)*cos(Y) + cos(X)*sin(Y) = cos(X + Y) = cos(X)*cos(Y) - sin(X)*sin(Y)",
    "odd": "sin(-X) = -sin(X) = cos(-X) = cos(X)",
    "quarter": "sin(X + pi/2) = cos(X) = cos(X + pi/2) = -sin(X)",
    "quarter back": "sin(X - pi/2) = -cos(X) = cos(X - pi/2) = sin(X)",
    "arc": "sin(atan2(X, Y)) = X/sqrt(X**2 + Y**2) = cos(atan2(X, Y)) = Y/sqrt(X**2 + Y**2)",
    "wrap": "sin(WRAPPED) = sin(X) = cos(WRAPPED) = cos(X)",
}
WRAPPED = "select_ge(pi, X, select_ge(X, -pi, X, X + 2*pi), X - 2*pi)"
RELATIONS = {"circle": "sin(X)**2 + cos(X)**2 - 1", "root": "sqrt(X)**2 - X", "sign": "copysign(1, X)**2 - 1"}
PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459")


def require(holds, message):
    """Return ``holds`` if it is true (such as a match of a pattern); otherwise raise ValueError with the message."""
    if not holds:
        raise ValueError(message)
    return holds


def nearest(value, real):
    """Return the exact ``value`` rounded to the digits of the C type ``real``, ties to even, for any exponent."""
    bits, shift = {"double": 53, "float": 24}[real], value.denominator.bit_length() - abs(value.numerator).bit_length()
    scale = Fraction(2) ** (bits + shift - (abs(value) * Fraction(2) ** shift >= 1))
    return round(value * scale) / scale


# A wrong equation of degree d passes with a probability of about d/2^128. Laws are proven with the cases, steps and
# cofactors that the certificate stores (laws/laws.py). recheck.py, which evaluates numbers and reads no proofs, shares
# only the check of seal and hashes. Headers are checked by hash alone. Titles, units, counts and digests of operations,
# flags, theorems, rounding bounds and object code are not checked here.
class RandomIntegers(defaultdict):
    """A dictionary that gives each new key a random integer, as the value of a variable or a function call."""

    # a function's key contains the values of its arguments, so that equal calls have equal values
    def __missing__(self, key):
        return self.setdefault(key, Fraction(secrets.randbits(128)))


class Evaluator:
    """An evaluator of formulas, or of C expressions; the values are exact fractions in both cases."""

    # ``real``: "double" or "float" for C, to which literals are rounded (sums are not); empty for formulas.
    # ``constants``: rounded literal -> the exact number for which it stands, such as 1/3. ``functions``: (name, *values
    # of arguments) -> value
    def __init__(self, names, functions, real="", calls=None, constants=(), cases=None):
        self.names, self.functions, self.real, self.calls = names, functions, real, calls
        self.constants, self.cases, self.limited_angles = dict(constants), cases, set()

    def parsed(self, text):
        """Return the syntax tree of the formula or C expression ``text``.

        Decimal numbers are strings in the tree, so that they stay exact.
        """
        require(
            text.isascii() and not re.search(r"//|\+\+|--|['\"\\#]", text), f"expected a formula, got {text[:60]!r}"
        )
        return ast.parse(NUMBER.sub(r"'\1'", text.strip()), mode="eval").body

    def read(self, text):
        """Return the value of the formula or C expression ``text``; ``self.names`` has the values of its variables."""
        return self.value(self.parsed(text))

    def value(self, node):
        """Return the value of an expression given as a syntax tree, ``node``, as :meth:`parsed` returns it."""
        match node:
            case ast.Constant(value=int(number)) if not self.real:
                return Fraction(number)
            case ast.Constant(value=str(text)) if self.real and text.endswith("f") == (self.real == "float"):
                number = Fraction(text.rstrip("f"))
                number = number and nearest(number, self.real)
                return self.constants.get(number, number)
            case ast.Name() | ast.Subscript():
                return self.names[ast.unparse(node)]
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -self.value(operand)
            case ast.BinOp(left=left, op=ast.Pow(), right=right) if not self.real:
                base, power = self.value(left), self.value(right)
                base, power = (self.call("sqrt", base), 2 * power) if power.denominator == 2 else (base, power)
                require(
                    power.denominator == 1 and abs(power) < 99,
                    f"expected a power that is a multiple of 1/2 below 99, got {power}",
                )
                return base**power
            case ast.BinOp(left=left, op=sign, right=right):
                return OPERATORS[type(sign)](self.value(left), self.value(right))
            case ast.IfExp(test=ast.Compare(left=left, ops=[sign], comparators=[right]), body=body, orelse=other):
                return self.call(CHOICES[type(sign)], *map(self.value, (left, right, body, other)))
            case ast.Call(func=ast.Name(id=name), args=[first, *others], keywords=[]):
                values = [self.value(first), *map(self.value, others)]
                if re.match("symrot_(?:(sin|cos)f?$|near_(?!arc_))", name):
                    self.limited_angles.add(values[0])
                return self.call(self.calls[name] if self.real else name, *values)
        raise ValueError(
            f"expected sums, products, powers and functions such as sin in a formula, got {ast.unparse(node)[:60]}"
        )

    def call(self, name, *values):
        """Return the value of the function ``name``, such as ``"sin"``, at the values of its arguments."""
        if self.cases is not None and name == "Abs":
            return self.call("copysign", Fraction(1), *values) * values[0]
        if self.cases is not None and name in SAFE and name != "select_ge":
            return Evaluator(dict(zip("xy", values, strict=False)), self.functions).read(SAFE[name][0])
        if self.cases and name == "select_ge" and values[:2] in self.cases:
            return values[2 if self.cases[values[:2]] == ">=" else 3]
        return self.functions[name, *values]

    def run(self, body, places, targets=()):
        """Evaluate the statements ``body`` of a C function, with values of its inputs from the map ``places``.

        Return the value after ``return``, or a map from each assigned output, such as ``"q[1]"``, to its value.
        ValueError is raised if an output is assigned twice or is not one of ``targets``.
        """
        self.names, results, statements = dict(places), {}, body.split(";")
        require(not statements.pop().strip(), f"expected a semicolon at the end, got {body[-60:]!r}")
        for place, statement in enumerate(statements, 1):
            match = require(STATEMENT.fullmatch(statement), f"expected a statement, got {statement[:60]!r}")
            real, name, formula, target, assigned, returned = match.groups()
            if returned:
                require(
                    place == len(statements), "expected the end of the function after return, got another statement"
                )
                return self.read(CHOICE.sub(r"(\4) if (\1) \2 (\3) else (\5)", returned))
            if name:
                require(
                    real == self.real and name not in (*self.names, *self.calls, "n", "k"),
                    f"expected a name that is not yet used, got {name}",
                )
                self.names[name] = self.read(formula)
            if target:
                target = ast.unparse(self.parsed(target))
                require(
                    target in targets and target not in results,
                    f"expected an output that is not assigned yet, got {target}",
                )
                results[target] = self.read(assigned)
        return results


class KernelCheck:
    """The check that a kernel's C functions, for one sample and for many (``_batch``), compute its formulas."""

    def __init__(self, name, data, c_functions):
        self.name, self.readback, self.spec, self.c_functions = name, data["readback"][name], data["spec"], c_functions
        self.real, self.symbols, self.functions = self.readback["type"], RandomIntegers(), RandomIntegers()
        self.end = end = {"double": "", "float": "f"}[self.real]
        static = [f for f in c_functions if c_functions[f][:2] == ("static inline ", self.real)]
        self.static = {f: f.removeprefix("symrot_").removeprefix("near_").removesuffix(end) for f in static}
        ranged = ("sin", "cos", "atan2", "select_lt", "select_eq") if "symrot_math.h" in data["files"] else ()
        self.calls = {f + end: f for f in MATH} | {f"fabs{end}": "Abs"} | {f"symrot_{f}{end}": f for f in ranged}
        self.calls |= {f"symrot_choose_ge{end}": "select_ge"} if ranged else {}
        self.calls |= self.static
        inputs = {place: self.spec["parameters"].get(symbol, symbol) for place, symbol, _ in data["inputs"]}
        parameters = {symbol for place, symbol, _ in data["inputs"] if place.startswith("p[")}
        require(
            {*self.spec["parameters"]} == parameters,
            "expected the same parameters in the formulas and among the inputs, "
            f"got {', '.join(sorted(self.spec['parameters']))} and {', '.join(sorted(parameters))}",
        )
        require(
            all(symbol.isidentifier() for _, symbol, _ in data["inputs"]),
            "expected the name of a variable for each input, got other text",
        )
        require(
            len({*inputs.values(), "pi"}) == len(data["inputs"]) + 1,
            "expected inputs that differ from each other and from pi, got one of them twice, or pi",
        )
        formula = Evaluator(self.symbols, self.functions)
        self.inputs = {place: formula.read(text) for place, text in inputs.items()}
        for symbol, text in self.spec["named"]:
            self.symbols[symbol] = formula.read(text)
        self.outputs = {place: formula.read(text) for place, _, text in self.spec["formulas"]}
        self.constants = dict(map(self.constant, self.readback["constants"]))

    def constant(self, pair):
        """Check that a constant of the C text is the rounded value of an exact number, such as 1/3 or pi/2.

        Return both numbers; ``pair`` has them as text.
        """
        written, exact = Fraction(pair[0]), Fraction(pair[1].removesuffix("*pi"))
        times_pi = pair[1].endswith("*pi")
        require(
            nearest(exact * PI if times_pi else exact, self.real) == written,
            f"expected the constant nearest to {pair[1]}, got {written}",
        )
        return written, exact * self.symbols["pi"] if times_pi else exact

    def run(self, body, places, targets=(), tested=()):
        """Evaluate the statements ``body`` of a C function; return its value, or a map from outputs to their values.

        ``places`` maps each input of the body, such as ``"q[0]"``, to its value. ``targets`` are the outputs that the
        body may assign. Some functions, such as ``symrot_sin``, are accurate only for angles up to a limit. ``tested``
        lists, as C expressions, the angles that the C text compares with this limit, by ``symrot_far``. ValueError is
        raised if the body calls such a function for an angle that is not in ``tested``.
        """
        reader = Evaluator({}, self.functions, self.real, self.calls, self.constants if targets else ())
        computed = reader.run(body, places, targets)
        require(
            reader.limited_angles <= set(map(reader.read, tested)),
            f"{self.name} calls a function that is accurate only for small angles, for an angle that the C text does "
            "not test",
        )
        return computed

    def check(self):
        """Check that the functions for one sample and for many samples (``_batch``) compute the formulas."""
        for function, name in self.static.items():
            self.check_static(function, name)
        places = [*self.inputs, *self.outputs]
        bases = dict.fromkeys(place.partition("[")[0] for place in places)
        for base in bases:
            own = [place for place in places if place.partition("[")[0] == base]
            bases[base] = 0 if own == [base] else len(own)
            require(
                own in ([base], [f"{base}[{k}]" for k in range(len(own))]),
                f"expected the components of one argument, such as q[0], q[1], numbered from 0, got {', '.join(own)}",
            )
        typed = {base: "const " * (f"{base}[0]" not in self.outputs) + self.real for base in bases}
        one = [f"{typed[base]} {base}[{size}]" if size else f"{self.real} {base}" for base, size in bases.items()]
        many = [one[k] if base == "p" else f"{typed[base]} *SYMROT_RESTRICT {base}" for k, base in enumerate(bases)]
        require(
            self.c_functions[self.name][1:3] == ("void", ", ".join(one)),
            f"expected the arguments {', '.join(one)} of {self.name}, as in the certificate, got others",
        )
        _, kind, arguments, loops = self.c_functions[f"{self.name}_batch"]
        require(
            (kind, arguments) == ("void", ", ".join(["size_t n", *many])),
            f"expected the arguments {', '.join(['size_t n', *many])} of {self.name}_batch, got {arguments}",
        )

        def of_sample(place):
            base, _, index = place.partition("[")
            if base == "p" or not index:
                return place if base == "p" else f"{base}[k]"
            return f"{base}[{ {'0]': '', '1]': 'n + '}.get(index, index[:-1] + ' * n + ') }k]"

        batch = {of_sample(place): value for place, value in self.inputs.items()}
        self.compare([self.c_functions[self.name][3]], self.inputs, self.outputs)
        if loop := LOOP.fullmatch(loops) or PARTS.fullmatch(loops):
            return self.compare(loop.groups(), batch, map(of_sample, self.outputs))
        bits, first, far, again = require(
            BLOCKS.fullmatch(loops), f"expected a loop over all samples in {self.name}_batch, got {loops[:60]!r}"
        ).groups()
        tested = re.findall(rf"symrot_far{self.end}\(((?:[^()]|\([^()]*\))*)\)", far)
        holds = far == " + ".join(f"symrot_far{self.end}({each})" for each in tested)
        require(
            holds and bits == {"double": "64", "float": "32"}[self.real],
            f"expected a sum of calls symrot_far{self.end}(angle), one for each angle, got {far!r}",
        )
        self.compare([first], batch, map(of_sample, self.outputs), tested)
        self.compare([again], batch, map(of_sample, self.outputs))

    def compare(self, bodies, places, targets, tested=()):
        """Check that C statements assign to each target, such as ``"q[1]"``, the value of its formula.

        ``bodies`` are the bodies of the loops of a function, executed one after another, or the body of a function
        without loops. ``targets`` are the kernel's outputs in their order, as the C text writes them. For ``places``
        and ``tested`` see :meth:`run`.
        """
        targets, computed = [*targets], {}
        for body in bodies:
            computed |= self.run(body, places, [target for target in targets if target not in computed], tested)
        for target, (place, expected) in zip(targets, self.outputs.items()):
            require(
                target in computed and computed[target] == expected,
                f"expected {place} of {self.name} to be the value of its formula, but the C text computes another",
            )

    def check_static(self, function, name):
        """Check that a static C function, such as ``symrot_sinc``, computes the function ``name``, here ``sinc``.

        ``function`` is the name of the C function, which is defined in the kernel's C file.
        """
        # near x = 0 the C text may compute a Taylor series instead, whose error the certificate states
        (explicit, case), (_, _, arguments, body) = SAFE[name], self.c_functions[function]
        for _, split, coefficients, rest in (each for each in self.readback["series"] if each[0] == name):
            taylor = [(-1) ** k * TAYLOR[name](k) for k in range(len(coefficients) + 1)]
            falling = [abs(each) * Fraction(split) ** k for k, each in enumerate(taylor)]
            holds = sorted(falling, reverse=True) == falling and [*map(Fraction, coefficients)] == taylor[:-1]
            holds = holds and Fraction(rest) == falling[-1] / (falling[0] - falling[1])
            require(
                holds, f"expected the Taylor series of {name} with the bound of its error, got another series or bound"
            )
            series = [f"({nearest(each, self.real)})*x**{2 * k}" for k, each in enumerate(taylor[:-1])]
            case = case.format(series=" + ".join(series), split=split)
        names = [argument.removeprefix(f"{self.real} ") for argument in arguments.split(", ")]
        values = [self.symbols[f"an argument {k}"] for k in range(4)]
        expected = Evaluator(dict(zip("xyzw", values)), self.functions).read(f"{case} else {explicit}")
        computed = self.run(body, dict(zip(names, values)), tested=names[:1] * function.startswith("symrot_near_"))
        require(
            computed == expected,
            f"expected {function} to compute {case} else {explicit}, but it computes another value",
        )


class FloatFunctions(dict):
    """A dictionary from (function name, *argument values) to the function's value, computed with floats.

    A value, as a Fraction, is computed at each look-up.
    """

    def __missing__(self, call):
        return Fraction(getattr(math, call[0])(*map(float, call[1:])))


def hypotheses(values):
    """Return polynomials that are all zero if the values form a unit vector, unit quaternion or rotation matrix."""
    if len(values) != 9:
        return [sum(each**2 for each in values) - 1] if values else []
    # nine values: a matrix, row by row
    rows, pairs = [values[:3], values[3:6], values[6:]], [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]
    columns = [[row[k] for row in rows] for k in range(3)]
    normal = [sum(map(operator.mul, of[i], of[j])) - (i == j) for of in (columns, rows) for i, j in pairs]
    for a, b, c in ((columns[k - 2], columns[k - 1], columns[k]) for k in (2, 0, 1)):
        normal += [a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] - c[k] for k in range(3)]
    return normal


def prove(law, case, formulas):
    """Raise ValueError if a law's proof is wrong for one ``case``: one choice of a branch of each conditional."""
    witness = {name: Fraction(text) for name, text in law["witness"].items()} | {"pi": PI}
    there, reader = (
        Evaluator(witness, FloatFunctions(), cases={}),
        Evaluator(RandomIntegers(), RandomIntegers(), cases={}),
    )
    # relations are polynomials that are known to be zero
    relations, roots = hypotheses([*map(reader.read, law["given"])]), set()
    require(
        not any(hypotheses([*map(there.read, law["given"])])),
        "expected the hypotheses of the law to hold at its witness (a stored point), but they do not",
    )

    # value (an expression that the law states to be zero) times factor must be the sum of cofactors times relations
    def combined(value, factor, cofactors):
        # no hidden division by zero: at the witness, where the hypotheses hold, factors are not zero and cofactors
        # finite
        holds = abs(there.read(factor)) > 1e-6 and all(abs(there.read(text)) < 1e6 for _, text in cofactors)
        total = sum(reader.read(text) * relations[place] for place, text in cofactors)
        return holds and value * reader.read(factor) == total

    def never_negative(text):
        even = re.compile(r"\b(\w+?)(\*\*\d*[02468])?\b(?!\*\*)")
        plain = even.sub(lambda m: "1" if m[2] or m[1] in roots else m[0], text.replace(" ** ", "**"))
        return re.fullmatch(r"[\d+*/() ]+", plain)

    for kind, first, *rest in case["steps"]:
        second = rest[0] if rest else ""
        if kind == "name":
            require(
                re.fullmatch(r"g\d+_", first) and first not in witness,
                f"expected a name that is not yet used, got {first}",
            )
            reader.names[first], witness[first] = reader.read(second), there.read(second)
            match reader.parsed(second):
                case ast.Call(func=ast.Name(id="sqrt")):
                    roots.add(first)
                case ast.Call(func=ast.Name(id="atan2"), args=[y, _]) if never_negative(ast.unparse(y)):
                    roots.add(first)
                case ast.Call(func=ast.Name(id="sin" | "cos" | "atan2" | "copysign")):
                    pass
                case _:
                    raise ValueError(
                        f"expected the name {first}, which the proof introduces, to stand for a call of sqrt, sin, "
                        f"cos, atan2 or copysign, got {second[:60]!r}"
                    )
        elif kind == "square":
            square, value = map(reader.read, (first, second))
            holds = never_negative(second) and combined(square - value**2, *rest[1:])
            reader.functions["sqrt", square] = (
                require(holds, f"expected {second} to be the square root of {first}, but its square differs") and value
            )
        else:
            fill = (RELATIONS | FACTS)[kind].replace("WRAPPED", WRAPPED)
            arguments = {"X": f"({first})", "Y": f"({second})"}
            sides = re.sub("[XY]", lambda name, arguments=arguments: arguments[name[0]], fill).split(" = ")
            relations += [reader.read(sides[0])] if kind in RELATIONS else []
            for left, right in zip(sides[::2], sides[1::2]):
                node = reader.parsed(left)
                reader.functions[node.func.id, *map(reader.value, node.args)] = reader.read(right)
    require(
        relations == [*map(reader.read, case["relations"])],
        f"expected the relations in the proof of the law {law['law']!r} to be those that its steps state, got others",
    )
    reader.cases = {(reader.read(left), reader.read(right)): sign for left, sign, right in case["case"]}
    for name, text in formulas:
        require(name not in reader.names and name.isidentifier(), f"expected a name that is not yet used, got {name}")
        reader.names[name] = reader.read(text)
    require(
        len(case["entries"]) == len(law["vanishing"]),
        f"expected a proof for each expression of the law {law['law']!r}, got more or fewer",
    )
    for text, entry in zip(law["vanishing"], case["entries"]):
        require(
            combined(reader.read(text), *entry),
            f"expected the law {law['law']!r} to follow from the formulas, but its stored proof is wrong",
        )


def complete(cases):
    """Return whether the cases of a law's proof are complete: whether they cover both branches of each conditional.

    A law is an identity that the kernel's formulas obey. If the formulas contain conditionals, the law is proven case
    by case: each case assumes, for each conditional that matters in it, which of the two branches applies.
    """
    if not cases or not cases[0]:
        return len(cases) == 1
    # ``cases``: for each case its assumptions [left, relation, right], with the relation "<" or ">="
    left, _, right = cases[0][0]
    branches = [[case[1:] for case in cases if case and case[0] == [left, sign, right]] for sign in ("<", ">=")]
    return len(cases) == sum(map(len, branches)) and all(map(complete, branches))


def functions_of(text, name, files):
    """Return a map from the name of each function in a C text to (prefix, type, arguments, body).

    The prefix is ``"static inline "`` or empty. The text may include only <math.h>, the header of the kernel ``name``,
    and symrot_math.h if it is in ``files``.
    """
    odd = re.search(r"\\|\?\?|//|[\0-\x09\x0b-\x1f]", text)
    require(not odd, f"expected no backslash, trigraph, // comment or control character, got {odd and odd[0]!r}")
    known = ["#include <math.h>", f'#include "{name}.h"', *['#include "symrot_math.h"'] * ("symrot_math.h" in files)]
    lines = [line for line in re.sub(r"/\*.*?\*/", " ", text, flags=re.S).split("\n") if line.strip() not in known]
    functions, (*chunks, end) = {}, re.split(r"^\}$", "\n".join(lines), flags=re.M)
    require(not end.strip(), f"expected a function, got {end.strip()[:60]!r}")
    for chunk in chunks:
        head = require(
            HEAD.fullmatch(" ".join(chunk.split()) + " "), f"expected a function, got {chunk.strip()[:60]!r}"
        )
        require(
            head[3] not in functions and (not head[1] or head[3].startswith("symrot_")),
            f"expected each function once, and symrot_ before the name of a static function, got {head[3]}",
        )
        functions[head[3]] = head.group(1, 2, 4, 5)
    return functions


def check(path):
    """Check the certificate at ``path`` and its files exactly; return one line that lists the checks.

    If a check fails, an exception is raised whose type is in ``REFUSALS``.
    """
    path = Path(path)
    data = recheck.certified(path)
    name, files, spec, readback = data["kernel"], data["files"], data["spec"], data["readback"]
    c_functions = functions_of(path.with_name(f"{name}.c").read_text("utf-8"), name, files)
    expected = {f"{function}{end}" for function in readback for end in ("", "_batch")}
    public = {f for f in c_functions if not c_functions[f][0]}
    require(
        public == expected, f"expected the functions {', '.join(sorted(expected))}, got {', '.join(sorted(public))}"
    )
    for function in readback:
        KernelCheck(function, data, c_functions).check()
    formulas = [*spec["named"], *(item[1:] for item in spec["formulas"])]
    for law in require(data["laws"], "expected laws, got none"):
        require(
            complete([case["case"] for case in law["cases"]]),
            f"expected a proof of the law {law['law']!r} for both branches of every conditional, got fewer cases",
        )
        for case in law["cases"]:
            prove(law, case, formulas)
    checked = " and ".join(readback)
    laws = "1 law is proven" if len(data["laws"]) == 1 else f"{len(data['laws'])} laws are proven"
    return (
        f"{name}: {len(files)} hashes agree; the C text of {checked}, and of their batch functions, computes the "
        f"formulas; {laws} from the formulas; the rounding bounds were not checked"
    )


REFUSALS = (ArithmeticError, AttributeError, LookupError, MemoryError, OSError, RecursionError, SyntaxError, TypeError)
REFUSALS += (ValueError,)


def sentence(reason):
    """Return a sentence for the user about ``reason``, the exception that a failed check raised."""
    if isinstance(reason, (SyntaxError, LookupError)):
        return (
            f"the certificate does not follow its schema, or the C text is not as symrot emits it ({reason.args[0]!r})"
        )
    is_sentence = isinstance(reason, (ValueError, OSError))
    text = str(reason) if is_sentence else f"the certificate does not follow its schema ({reason!r})"
    return text if len(text) <= 400 else f"{text[:200]} .. {text[-200:]}"
