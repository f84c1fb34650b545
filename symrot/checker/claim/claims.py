"""Claims as they are written, in a text or in a TOML file, and read: trees first, then their meaning.

A claim keeps its trees, since its diagnosis edits them. Nothing about verdicts is in a file of claims.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from sympy import Symbol

from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.interpreter import CONSTANTS, Meaning, time
from symrot.checker.claim.reader import Relation, read_expression, read_relation
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.tree import Node, text, walk
from symrot.checker.decide.decision import Problem
from symrot.checker.latex.reader import Names, read_latex
from symrot.checker.units.units import read_unit
from symrot.errors import InputError

__all__ = ["Claim", "Refusal", "claim_of_text", "named_formula", "read_claims", "read_entries", "shown_relation"]


@dataclass(frozen=True)
class Claim:
    """One claim with everything it needs.

    ``relation`` is None for a worked number, which has ``value`` and ``printed`` instead. ``alternatives`` are other
    readings of a document that lost characters.
    """

    id: str = ""
    where: str = ""
    symbols: tuple[str, ...] = ()
    functions: tuple[str, ...] = ()
    define: tuple[tuple[str, Node], ...] = ()
    given: tuple[Relation, ...] = ()
    relation: Relation | None = None
    value: Node | None = None
    printed: str = ""
    alternatives: tuple[Relation, ...] = ()
    implied: bool = False
    sources: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)

    @property
    def text(self) -> str:
        """The claim as text."""
        if self.relation is None:
            return f"{self.sources['value']} == {self.printed}"
        return self.sources.get("claim") or shown_relation(self.relation)

    def label(self, key: str) -> str:
        """Return the place of a text for complaints."""
        return f"{self.id}: {key}" if self.id else ""

    def meaning(self) -> Meaning:
        """Return the names of the claim: symbols, those that hypotheses make positive, then definitions."""
        meaning = Meaning(implied=self.implied, functions=set(self.functions))
        positive = _assumed(self.given, ">")
        nonnegative = _assumed(self.given, ">=")
        names = [*self.symbols, *(positive | nonnegative if self.implied else ())]
        for name in names:
            if name in positive:
                meaning.values[name] = Symbol(name, positive=True)
            elif name in nonnegative:
                meaning.values[name] = Symbol(name, nonnegative=True)
            else:
                meaning.values[name] = time if name == "t" else Symbol(name, real=True)
        for number, (name, node) in enumerate(self.define):
            source, place = self.sources.get(f"define.{number}", ""), self.label(f"define {name}")
            meaning.values[name] = meaning.read(node, source, place)
        return meaning

    def problem(self) -> Problem:
        """Return the equation that is to be decided.

        Raises
        ------
        InputError
            For a piece that has no meaning, with its place.
        """
        assert self.relation is not None
        meaning = self.meaning()
        hypotheses, nonzero = [], []
        for number, relation in enumerate(self.given):
            sign, left, right = relation
            source = self.sources.get(f"given.{number}", "")
            lhs, rhs = (meaning.read(side, source, self.label("given")) for side in (left, right))
            if sign == "==":
                hypotheses.extend(_entries(lhs, rhs, self.label("given")))
            elif sign == "!=":
                nonzero.extend(_entries(lhs, rhs, self.label("given")))
        source = self.sources.get("claim", "")
        left, right = self.relation[1:]
        lhs = meaning.read(left, source, self.label("claim"))
        rhs = lhs if right is left else meaning.read(right, source, self.label("claim"))
        divisors = tuple(dict.fromkeys(divisor.value for divisor in meaning.divisors))
        radicands = tuple(dict.fromkeys(meaning.radicands))
        return Problem(lhs, rhs, tuple(hypotheses), divisors, tuple(nonzero), radicands)


def shown_relation(relation: Relation) -> str:
    """Return a relation as text."""
    sign, left, right = relation
    return f"{text(left)} {sign} {text(right)}"


def _entries(left: Any, right: Any, where: str) -> list[Any]:
    """Return the scalar equations of a hypothesis, each as an expression that is zero."""
    from symrot.exact.decide import flatten

    (lefts, shape), (rights, other) = flatten(left), flatten(right)
    if shape is not None and other is None and rights == [0]:
        rights, other = [rights[0]] * len(lefts), shape
    if shape != other:
        raise InputError(f"{where}: expected a hypothesis with two sides of one shape")
    return [a - b for a, b in zip(lefts, rights, strict=True)]


def _assumed(given: Sequence[Relation], sign: str) -> set[str]:
    """Return the names x of hypotheses ``x > 0`` (or ``0 < x``)."""
    mirrored = {">": "<", ">=": "<="}[sign]
    zero = ("number", 0)
    found = set()
    for mark, left, right in given:
        if mark == mirrored:
            left, right = right, left
        if mark in (sign, mirrored) and left.kind == "name" and (right.kind, right.value) == zero:
            found.add(left.value)
    return found


def _hypothesis(source: str, where: str) -> Relation:
    relation = read_relation(source, where)
    if relation[0] in ("==", "!=") or _assumed([relation], ">") or _assumed([relation], ">="):
        return relation
    raise InputError(f"{where}: expected a hypothesis like a == b, a != b, or x > 0 for a symbol x, got {source!r}")


def claim_of_text(source: str, given: Sequence[str] = (), units: Mapping[str, str] | None = None) -> Claim:
    """Return the claim of a text ``left == right`` or of LaTeX, text with a backslash, a brace or a dollar.

    Its names are real symbols, or functions of time where they are written ``f(t)``, in the hypotheses too.
    """
    hypotheses = tuple(_hypothesis(text, "given") for text in given)
    if isinstance(source, str) and _is_latex(source):
        source = read_latex(source, names=Names(functions=_functions_of_time(hypotheses))).text
    relation = read_relation(source)
    if relation[0] != "==":
        raise InputError(f"expected a claim with '==', got '{relation[0]}' in {source[:60]!r}")
    sources = {"claim": source.strip(), **{f"given.{n}": text for n, text in enumerate(given)}}
    used = {str(node.value) for side in relation[1:] for _, node in walk(side) if node.kind in ("name", "call")}
    return Claim(
        relation=relation,
        given=hypotheses,
        implied=True,
        sources=sources,
        units=_units(dict(units or {}), used, "claim"),
    )


def named_formula(claim: Claim) -> tuple[str, Node] | None:
    """Return (name, formula) of a claim one side of which only gets a name; None for another claim.

    The name is a symbol, a function of time or its derivative; nothing else in the claim says what it stands for.
    """
    assert claim.relation is not None
    _, left, right = claim.relation
    others = [side for relation in claim.given for side in relation[1:]] + [tree for _, tree in claim.define]
    known = {"pi", "t", *(name for name, _ in claim.define)}
    for side, formula in ((left, right), (right, left)):
        inner = side.args[0] if side.kind == "call" and side.value == "diff" else side
        if _is_name(inner) and inner.value not in known and not _is_name(formula):
            elsewhere = [node for tree in (formula, *others) for _, node in walk(tree)]
            if side not in elsewhere and not (inner is side and inner.value in [n.value for n in elsewhere]):
                return str(inner.value), formula
    return None


def _is_name(tree: Node) -> bool:
    return tree.kind == "name" or (tree.kind == "call" and [a.value for a in tree.args] == ["t"])


# -- TOML -------------------------------------------------------------------------------------------------------------

TEXTS = ("id", "where", "source", "note", "printed", "kind", "claim", "latex", "value", "printed_value", "against")
LISTS = ("symbols", "functions", "given", "alternatives", "lost")
OTHERS = ("define", "units")
"""Keys of a claim by the shape of their value."""

FILE_KEYS = ("schema", "claim", "document", "title", "kind", "lost", "note")
"""Keys of a file: the last five tell of a document whose claims it holds."""

MOST_CLAIMS = 2000
MOST_NAMES = 500
"""Claims of a file, and names that one claim may declare or define."""


@dataclass(frozen=True)
class Refusal:
    """An entry of a file that is no claim: its id, place and text as given, and the sentence that says why."""

    id: str
    where: str
    text: str
    reason: str


def read_claims(path: str | Path) -> list[Claim]:
    """Return the claims of a TOML file, all of which must be good.

    Raises
    ------
    InputError
        Naming the file, the claim, the key, and what is expected there.
    """
    found = read_entries(path)
    for entry in found:
        if isinstance(entry, Refusal):
            raise InputError(entry.reason)
    return [entry for entry in found if isinstance(entry, Claim)]


def read_entries(path: str | Path) -> list[Claim | Refusal]:
    """Return the claims of a TOML file; where one cannot be read, why.

    Raises
    ------
    InputError
        If the file as a whole is not one of claims.
    """
    from symrot.scene.file import read_toml

    label = str(path)
    table = read_toml(Path(path), label, "claim")
    if table.get("schema") != 1:
        raise InputError(f"{label}: expected schema = 1, got {table.get('schema')!r}")
    unknown = next((key for key in table if key not in FILE_KEYS), None)
    if unknown is not None:
        raise InputError(f"{label}: expected schema and [[claim]] tables, got the key {unknown[:40]!r}")
    found = table.get("claim")
    if not isinstance(found, list) or not found or not all(isinstance(entry, dict) for entry in found):
        raise InputError(f"{label}: expected [[claim]] tables, got {'none' if not found else 'something else'}")
    if len(found) > MOST_CLAIMS:
        raise InputError(f"{label}: expected at most {MOST_CLAIMS} claims in a file, got {len(found)}")
    entries: list[Claim | Refusal] = []
    names: set[str] = set()
    for number, entry in enumerate(found, start=1):
        try:
            claim = _claim(entry, number, label)
            if claim.id in names:
                raise InputError(f"{label}: expected every id once, got {claim.id!r} twice")
            names.add(claim.id)
            entries.append(claim)
        except InputError as reason:
            name, where, shown = (str(entry.get(key, other))[:80] for key, other in (
                ("id", f"claim-{number}"), ("where", ""), ("claim", entry.get("latex", "")),
            ))  # fmt: skip
            entries.append(Refusal(name, where, shown, str(reason)))
    return entries


def _claim(entry: dict[str, Any], number: int, label: str) -> Claim:
    name = entry.get("id", f"claim-{number}")
    if not isinstance(name, str):
        raise InputError(f"{label}: claim {number}: expected text as id, got {name!r}")
    place = f"{label}: {name}"
    for key, value in entry.items():
        _check_key(key, value, place)
    symbols, functions = _names(entry, "symbols", place), _names(entry, "functions", place)
    define, sources = [], {}
    known = {*symbols, *functions}
    if len(known) < len(symbols) + len(functions):
        raise InputError(f"{place}: expected every symbol and function to be declared once")
    if len(known) + len(entry.get("define", ())) > MOST_NAMES:
        raise InputError(f"{place}: expected at most {MOST_NAMES} names in a claim, got {len(known)} and more")
    for place_of, (defined, formula) in enumerate(entry.get("define", ())):
        _check_name(defined, "define", place)
        if defined in known:
            raise InputError(f"{place}: define: expected a new name, got {defined!r}, which is taken")
        known.add(defined)
        define.append((defined, read_expression(formula, f"{place}: define {defined}")))
        sources[f"define.{place_of}"] = formula
    given = tuple(_hypothesis(text, f"{place}: given") for text in entry.get("given", ()))
    sources |= {f"given.{n}": text for n, text in enumerate(entry.get("given", ()))}
    made = {
        "id": name, "where": entry.get("where", ""), "symbols": symbols, "functions": functions,
        "define": tuple(define), "given": given, "units": _units(entry.get("units", {}), known, place),
    }  # fmt: skip
    others = list(entry.get("alternatives", ()))
    kinds = [key for key in ("claim", "latex", "value") if key in entry]
    if not kinds and others:
        entry, kinds = {**entry, "claim": others.pop(0)}, ["claim"]
    if len(kinds) != 1:
        raise InputError(f"{place}: expected exactly one of claim, latex and value, got {', '.join(kinds) or 'none'}")
    if kinds == ["value"]:
        if "printed_value" not in entry:
            raise InputError(f"{place}: expected printed_value beside value, the key is missing")
        if others:
            raise InputError(f"{place}: alternatives: expected other readings of a claim, got them beside a value")
        sources["value"] = entry["value"]
        value = read_expression(entry["value"], f"{place}: value")
        return Claim(**made, value=value, printed=entry["printed_value"], sources=sources)
    (key,) = kinds
    names = None
    readings = []
    for number_of, (source, at) in enumerate([(entry[key], key), *((other, "alternatives") for other in others)]):
        if _is_latex(source) or (number_of == 0 and key == "latex"):
            names = names or _names_for_latex(Claim(**made, sources=sources))
            reading = read_latex(source, f"{place}: {at}", names)
            readings.append((reading.relation, reading.text))
        else:
            readings.append((_equation(source, f"{place}: {at}"), source))
    (relation, sources["claim"]), *rest = readings
    return Claim(**made, relation=relation, alternatives=tuple(found for found, _ in rest), sources=sources)


def _is_latex(source: str) -> bool:
    return any(mark in source for mark in "\\${")


def _functions_of_time(relations: Sequence[Relation]) -> set[str]:
    """Return the names f of pieces ``f(t)``."""
    return {
        node.value
        for relation in relations
        for side in relation[1:]
        for _, node in walk(side)
        if node.kind == "call" and node.value not in BUILT_IN and [part.value for part in node.args] == ["t"]
    }


def _units(given: dict[str, str], known: set[str], place: str) -> dict[str, str]:
    """Return the units of a claim, each of a declared name and of a unit that is known."""
    for name, unit in given.items():
        if name not in known:
            raise InputError(f"{place}: units: expected units of names that the claim has, got {str(name)[:40]!r}")
        if not isinstance(unit, str):
            raise InputError(f"{place}: units: expected the unit of {name} as text, got {unit!r}")
        read_unit(unit, f"{place}: units: {name}")
    return given


def _names_for_latex(claim: Claim) -> Names:
    """Return what is declared, with the definitions that are matrices, which LaTeX marks in its own ways."""
    values = claim.meaning().values
    defined = [name for name, _ in claim.define]
    matrices = {name for name in defined if is_matrix(values[name])}
    columns = {name for name in matrices if values[name].cols == 1}
    return Names(claim.symbols, claim.functions, matrices, columns, {*defined} - matrices, implied=False)


def _equation(source: str, where: str) -> Relation:
    relation = read_relation(source, where)
    if relation[0] != "==":
        raise InputError(f"{where}: expected '==', got '{relation[0]}' in {source[:60]!r}")
    return relation


def _check_key(key: str, value: Any, place: str) -> None:
    if key in TEXTS:
        expected, fits = "text", isinstance(value, str)
    elif key in LISTS:
        expected, fits = "a list of texts", isinstance(value, list) and all(isinstance(v, str) for v in value)
    elif key == "define":
        expected = 'a list of pairs ["name", "formula"]'
        fits = isinstance(value, list) and all(
            isinstance(pair, list) and len(pair) == 2 and all(isinstance(v, str) for v in pair) for pair in value
        )
    elif key == "units":
        expected = "a table of units by symbol"
        fits = isinstance(value, dict) and all(isinstance(v, str) for v in value.values())
    else:
        raise InputError(f"{place}: expected one of the keys {', '.join((*TEXTS, *LISTS, *OTHERS))}, got {key!r}")
    if not fits:
        raise InputError(f"{place}: {key}: expected {expected}, got {str(value)[:60]!r}")


def _names(entry: dict[str, Any], key: str, place: str) -> tuple[str, ...]:
    names = entry.get(key, [])
    for name in names:
        _check_name(name, key, place)
    if len(set(names)) < len(names):
        twice = next(name for number, name in enumerate(names) if name in names[:number])
        raise InputError(f"{place}: {key}: expected every name once, got {twice!r} twice")
    return tuple(names)


def _check_name(name: str, key: str, place: str) -> None:
    if not (name.isascii() and name.isidentifier() and name[0].isalpha()):
        raise InputError(f"{place}: {key}: expected a name of letters, digits and underscores, got {name[:40]!r}")
    if name in BUILT_IN or name in CONSTANTS:
        raise InputError(f"{place}: {key}: expected a name of your own, got {name!r}, which is built in")
