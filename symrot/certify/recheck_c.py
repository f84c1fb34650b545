"""The C text of a kernel is its formulas, for recheck.py: standard library, nothing of symrot.

Both are evaluated at random fractions.
Each function of <math.h> and each choice is one more random fraction for each of its arguments, so that a wrong text
passes one run with a chance of about its degree in 2^64. What computes the same is not told apart: unused statements,
-x where only x^2 counts. Functions of symrot_math.h are what they are called, where their angles are asked for.
"""

# mypy: ignore-errors
import math
import re
import secrets
from collections import defaultdict
from fractions import Fraction

if __package__:
    from .recheck_formula import PI, need, power, value, with_series, with_texts
else:  # as a script, beside the other files
    from recheck_formula import PI, need, power, value, with_series, with_texts

LOOP = "SYMROT_INDEPENDENT for (size_t k = start; k < end; ++k) {"
EACH = LOOP.replace("start", "0").replace("end", "n") + "}"
SPAN = "for (size_t start = 0; start < n; start += @) {const size_t end = n - start < @ ? n : start + @;"
PARTS = SPAN.replace("@", "SYMROT_SPAN") + 2 * (LOOP + "}") + "}"
BLOCKS = SPAN.replace("@", "SYMROT_BLOCK") + "uint%s_t beyond = 0;" + LOOP
BLOCKS += "}const size_t again = beyond == 0 ? start : end;for (size_t k = start; k < again; ++k) {}}"
PIECE = re.compile(r" ?((?:SYMROT_INDEPENDENT )?for \([^(){}]*\) \{|[^;{}]*[;{}])")
STATEMENT = re.compile(r"(?:const (double|float) (\w+) =|(\w+\[[^]]*\]) =|(return)) (.+);", re.A)
ASKED = re.compile(r"beyond \+= (symrot_farf?\([^();]*\)(?: \+ (?=s)|))+;")
MATH = "sin cos tan asin acos atan exp log sinh cosh tanh sqrt atan2 copysign fabs".split()  # noqa: SIM905
RANGED = ("sinc", "sine_gap", "tangent_gap")  # symrot_near_.. of these hold for angles in a range, as symrot_sin does


def nearest(number, real):
    """Return the number of a type that is nearest to another, ties to even."""
    exponent = math.frexp(number)[1]
    need(abs(exponent) < 120, "a number is too small or too large")
    scale = Fraction(2) ** ({"double": 53, "float": 24}[real] - exponent)
    return round(number * scale) / scale


def run(body, names, real, near, within=frozenset()):
    """Return what there is but statements, and what they give to places, or return: at first, then in each loop.

    Angles that functions with a range take are left in ``near`` by them: they have to be within, or asked for.
    """
    frame, found, local = "", [{}], dict(names)
    for piece in [*PIECE.findall(body), PIECE.sub("", body).strip()]:
        if (match := STATEMENT.fullmatch(piece)) and (not frame or frame.endswith("++k) {")):
            kind, name, place, back, formula = match.groups()
            need(kind in (None, real) and name not in {*local, "n", "k"}, f"{name} is no new {real}")
            need((place or back) not in found[-1] and "return" not in found[-1], f"{place or back} is there twice")
            (local if name else found[-1])[name or place or back] = value(formula, local)
        elif ASKED.fullmatch(piece) and frame.endswith("beyond = 0;" + LOOP):
            near -= {value(angle, local) for angle in re.findall(r"\(([^()]*)\)", piece)}
        elif not re.fullmatch(r"(\(void\)\w+;)?", piece):
            frame += piece
            need(near <= within, "functions take angles beyond their range")
            if piece.endswith("++k) {"):
                found, local = [*found, {}], dict(names)
    need(near <= within, "functions take angles beyond their range")
    near.clear()
    return frame, found


def arguments(inputs, places, real):
    """Return what a function of one sample takes, and one of many."""
    one, many = [], ["size_t n"]
    for base in dict.fromkeys(place.partition("[")[0] for place in places):
        own = [place for place in places if place.partition("[")[0] == base]
        need(own in ([base], [f"{base}[{k}]" for k in range(len(own))]), f"{own[0]} and others are no argument")
        typed = "const " * (own[0] in inputs) + real
        one.append(f"{real} {base}" if own == [base] else f"{typed} {base}[{len(own)}]")
        many.append(one[-1] if base == "p" else f"{typed} *SYMROT_RESTRICT {base}")
    return ", ".join(one), ", ".join(many)


def check_c(name, data, found):
    """Refuse a function, of one sample and of many, that is not its formulas."""
    said, spec, near = data["readback"][name], data["spec"], set()
    real = said["type"]
    end, bits = {"double": ("", 64), "float": ("f", 32)}[real]
    drawn = defaultdict(lambda: Fraction(secrets.randbits(64)))  # of each name, of each function and its arguments
    plain = {f: lambda *x, f=f: drawn[f, *x] for f in [*MATH, "choose"]}
    exact = {"at": lambda text: Fraction(int(text)), "power": power}
    texts, coefficients = with_series(said["series"])
    constants = {nearest(each, real): each for each in coefficients}
    safe = with_texts(plain | exact, texts)
    names = defaultdict(drawn.default_factory, safe)
    for written, means in said["constants"]:
        holds = nearest(value(means, exact | {"pi": Fraction(PI)}), real) == Fraction(written)
        need(holds, f"{written} does not stand for {means}")
        constants[Fraction(written)] = value(means, names)
    inputs = {place: value(spec["parameters"].get(symbol, symbol), names) for place, symbol, _ in data["inputs"]}
    need(len({*inputs.values(), names["pi"]}) == len(data["inputs"]) + 1, "two inputs are one")
    need({*spec["parameters"]} <= {symbol for _, symbol, _ in data["inputs"]}, "a parameter is no input")
    for symbol, text in [*spec["named"], *(each[1:] for each in spec["formulas"])]:
        need(symbol not in {*names, *spec["parameters"]}, f"{symbol} is no new name")
        names[symbol] = value(text, names)
    wanted = {place: names[symbol] for place, symbol, _ in spec["formulas"]}

    one, many = arguments(inputs, [*inputs, *wanted], real)
    holds = found[name][1] == one and found[f"{name}_batch"][1] == many
    need(holds, f"{name} has other arguments")

    known = {f + end: plain[f] for f in MATH} | {"choose": plain["choose"]}
    known |= {f"symrot_{f}{end}": safe[f] for f in ("select_lt", "select_eq")}
    known |= {f"symrot_choose_ge{end}": safe["select_ge"], f"symrot_atan2{end}": plain["atan2"]}
    known |= {f"symrot_{f}{end}": lambda x, f=f: near.add(x) or plain[f](x) for f in ("sin", "cos")}

    def reading(at_places):
        """Return the names of C where these places can be read."""

        def at(text):
            if text.endswith("]"):
                return at_places[text]
            need(re.fullmatch(rf"(\d+\.\d*|\d+(?=e))(e[-+]?\d\d?)?{end}", text), f"{text} is no {real}")
            number = nearest(Fraction(text.removesuffix("f")), real)
            return constants.get(number, number)

        return known | {place: each for place, each in at_places.items() if "[" not in place} | {"at": at}

    for function, (kind, listed, body) in found.items():
        if kind == f"static inline {real}":
            close, bare = re.fullmatch(rf"symrot_(near_|)(\w+?){end}", function).groups()
            numbers = {each.removeprefix(f"{real} "): drawn[each] for each in listed.split(", ")}
            means, angle = safe[bare](*numbers.values()), next(iter(numbers.values()))
            ranged = close and bare in RANGED
            holds = run(body, reading(numbers), real, near, {angle} if ranged else set()) == ("", [{"return": means}])
            need(holds, f"{function} is not what its name says")
            known[function] = (lambda *x, f=bare: near.add(x[0]) or safe[f](*x)) if ranged else safe[bare]
    holds = run(found[name][2], reading(inputs), real, near) == ("", [wanted])
    need(holds, f"{name} is not its formulas")

    def of_samples(values):
        many = ((place if place[:2] == "p[" else place.replace("]", "*n + k]"), each) for place, each in values.items())
        return {place if "[" in place else f"{place}[k]": each for place, each in many}

    frame, (before, *loops) = run(found[f"{name}_batch"][2], reading(of_samples(inputs)), real, near)
    if frame in (EACH, PARTS):
        loops = [{place: each for loop in loops for place, each in loop.items()}]
    holds = frame in (EACH, PARTS, BLOCKS % bits) and all(loop == of_samples(wanted) for loop in loops)
    need(holds and not before, f"{name}_batch is not its formulas")
