"""Reading claims from a TOML file, which holds equations and definitions for ``check``, but no verdicts on them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from symrot.checker.claim.claims import SIDES, Claim
from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.interpreter import CONSTANTS
from symrot.checker.claim.reader import read_expression, read_relation
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.source.text import check_units, is_latex, read_hypothesis
from symrot.checker.claim.tree import Node
from symrot.checker.context.context import quantities_of
from symrot.checker.context.statements import read_context
from symrot.checker.latex.reader import Names, read_latex
from symrot.checker.typed.readings import Declared, Relation
from symrot.errors import InputError
from symrot.files.paths import path_of

__all__ = ["Refusal", "read_claims", "read_entries"]

TEXT_KEYS = (
    "id", "body", "frame", "sequence", "source", "note", "printed", "kind", "claim", "latex", "value", "printed_value",
    "against",
)  # fmt: skip
"""The keys of a claim in a file whose value is a text."""
LIST_KEYS = ("symbols", "functions", "given", "alternatives", "lost", "editable")
"""The keys of a claim in a file whose value is a list of texts."""
OTHER_KEYS = ("where", "define", "units")
"""The keys of a claim in a file whose value has another type, such as a table; ``_check_key`` describes each."""

FILE_KEYS = ("schema", "claim", "document", "title", "kind", "lost", "note")
"""The keys at the top of a file of claims; the last five describe the document from which its claims come."""

MOST_CLAIMS = 2000
"""The largest number of claims in a file."""
MOST_NAMES = 500
"""The largest number of names that one claim may declare or define."""


@dataclass(frozen=True)
class Refusal:
    """A claim of a file that cannot be read: its id, place and text, and a sentence with the reason."""

    id: str
    where: str
    text: str
    reason: str


def read_claims(path: str | Path) -> list[Claim]:
    """Return the claims of a TOML file.

    Raises
    ------
    InputError
        If the file or one of its claims cannot be read.
    """
    entries = read_entries(path)
    for entry in entries:
        if isinstance(entry, Refusal):
            raise InputError(entry.reason)
    return [entry for entry in entries if isinstance(entry, Claim)]


def read_entries(path: str | Path) -> list[Claim | Refusal]:
    """Return the claims of a TOML file, with a :class:`Refusal` in place of each claim that cannot be read.

    Raises
    ------
    InputError
        If the file as a whole is not a file of claims.
    """
    from symrot.scene.file import read_toml

    label = str(path)
    table = read_toml(path_of(path, "claims"), label, "claim")
    if table.get("schema") != 1:
        raise InputError(f"{label}: expected schema = 1, got {table.get('schema')!r}")
    unknown = next((key for key in table if key not in FILE_KEYS), None)
    if unknown is not None:
        raise InputError(f"{label}: expected schema and [[claim]] tables, got the key {unknown[:40]!r}")
    tables = table.get("claim")
    if not isinstance(tables, list) or not tables or not all(isinstance(entry, dict) for entry in tables):
        raise InputError(f"{label}: expected [[claim]] tables, got {'none' if not tables else 'other values'}")
    if len(tables) > MOST_CLAIMS:
        raise InputError(f"{label}: expected at most {MOST_CLAIMS} claims in a file, got {len(tables)}")
    entries: list[Claim | Refusal] = []
    names: set[str] = set()
    for number, entry in enumerate(tables, start=1):
        try:
            claim = _claim(entry, number, label)
            if claim.id in names:
                raise InputError(f"{label}: expected every id once, got {claim.id!r} twice")
            names.add(claim.id)
            entries.append(claim)
        except InputError as reason:
            name, where, excerpt = (str(entry.get(key, other))[:80] for key, other in (
                ("id", f"claim-{number}"), ("where", ""), ("claim", entry.get("latex", "")),
            ))  # fmt: skip
            place = where if isinstance(entry.get("where", ""), str) else ""
            entries.append(Refusal(name, place, excerpt, str(reason)))
    return entries


def _claim(entry: dict[str, Any], number: int, label: str) -> Claim:
    name = entry.get("id", f"claim-{number}")
    if not isinstance(name, str):
        raise InputError(f"{label}: claim {number}: expected a string as the value of id, got {name!r}")
    place = f"{label}: {name}"
    for key, value in entry.items():
        _check_key(key, value, place)
    symbols, functions = _names(entry, "symbols", place), _names(entry, "functions", place)
    define, sources = [], {}
    known = {*symbols, *functions}
    declared = [*symbols, *functions]
    if twice := [name for name in known if declared.count(name) > 1]:
        raise InputError(f"{place}: expected every symbol and function to be declared once, got {min(twice)!r} twice")
    count = len(known) + len(entry.get("define", ()))
    if count > MOST_NAMES:
        raise InputError(f"{place}: expected at most {MOST_NAMES} names in a claim, got {count}")
    for place_of, (defined, formula) in enumerate(entry.get("define", ())):
        _check_name(defined, "define", place)
        if defined in known:
            raise InputError(f"{place}: define: expected a new name, got {defined!r}, which the claim already uses")
        known.add(defined)
        own = Declared(known - {*functions}, functions)
        define.append((defined, read_expression(formula, f"{place}: define {defined}", own)))
        sources[f"define.{place_of}"] = formula
    own = Declared(known - {*functions}, functions)
    hypotheses = tuple(read_hypothesis(text, f"{place}: given", own) for text in entry.get("given", ()))
    sources |= {f"given.{n}": text for n, text in enumerate(entry.get("given", ()))}
    where = entry.get("where", "")
    meanings = [] if isinstance(where, str) else where
    body, frame, sequence = (str(entry.get(key, "")) for key in ("body", "frame", "sequence"))
    context = read_context(meanings, body, frame, sequence, label=place)
    units = check_units(entry.get("units", {}), known, place)
    claim = Claim(
        name, "" if meanings else where, symbols, functions, tuple(define), hypotheses, sources=sources,
        units={**context.units({*symbols}, units), **units}, editable=_editable(entry, define, place), context=context,
    )  # fmt: skip
    others = list(entry.get("alternatives", ()))
    kinds = [key for key in ("claim", "latex", "value") if key in entry]
    if not kinds and others:
        entry, kinds = {**entry, "claim": others.pop(0)}, ["claim"]
    if len(kinds) != 1:
        raise InputError(f"{place}: expected exactly one of claim, latex and value, got {', '.join(kinds) or 'none'}")
    if kinds == ["value"]:
        if "printed_value" not in entry:
            raise InputError(f"{place}: expected the key printed_value together with the key value, got value alone")
        if others:
            raise InputError(
                f"{place}: alternatives: expected this key together with claim or latex, got it together with value"
            )
        sources["value"] = entry["value"]
        value = read_expression(entry["value"], f"{place}: value", own)
        return replace(claim, value=value, printed=entry["printed_value"])
    (key,) = kinds
    names = None
    readings = []
    for number_of, (source, at) in enumerate([(entry[key], key), *((other, "alternatives") for other in others)]):
        if is_latex(source) or (number_of == 0 and key == "latex"):
            names = names or _names_for_latex(claim)
            reading = read_latex(source, f"{place}: {at}", names)
            readings.append((reading.relation, reading.text))
        else:
            readings.append((_equation(source, f"{place}: {at}", own), source))
    (relation, sources["claim"]), *rest = readings
    others = [*(side for hypothesis in hypotheses for side in hypothesis[1:]), *(tree for _, tree in define)]
    own_names, elsewhere = (
        {name for side in sides for name in quantities_of(side)} for sides in (relation[1:], others)
    )
    try:
        context.check_names(own_names, elsewhere)
    except InputError as reason:
        raise InputError(f"{place}: {reason}") from None
    return claim.with_relation(relation, alternatives=tuple(other for other, _ in rest))


def _names_for_latex(claim: Claim) -> Names:
    """Return the names that a claim declares, sorted into symbols, functions, matrices, vectors and defined scalars.

    The reader of LaTeX needs them.
    """
    values = claim.definitions.values
    defined = [name for name, _ in claim.define]
    matrices = {name for name in defined if is_matrix(values[name])}
    columns = {name for name in matrices if values[name].cols == 1}
    return Names(claim.symbols, claim.functions, matrices, columns, {*defined} - matrices, implied=False)


def _equation(source: str, where: str, declared: Declared) -> Relation:
    relation = read_relation(source, where, declared)
    if relation[0] != "==":
        raise InputError(f"{where}: expected '==', got '{relation[0]}' in {source[:60]!r}")
    return relation


def _check_key(key: str, value: Any, place: str) -> None:
    if key in TEXT_KEYS:
        expected, fits = "a string", isinstance(value, str)
    elif key in LIST_KEYS:
        expected, fits = "a list of strings", isinstance(value, list) and all(isinstance(v, str) for v in value)
    elif key == "define":
        expected = 'a list of pairs ["name", "formula"]'
        fits = isinstance(value, list) and all(
            isinstance(pair, list) and len(pair) == 2 and all(isinstance(v, str) for v in pair) for pair in value
        )
    elif key == "where":
        expected = "a place in a document, such as 'p. 12', or a list of meanings, such as ['J = moment of inertia']"
        fits = isinstance(value, str) or (isinstance(value, list) and all(isinstance(v, str) for v in value))
    elif key == "units":
        expected = "a table of units by symbol"
        fits = isinstance(value, dict) and all(isinstance(v, str) for v in value.values())
    else:
        keys = ", ".join((*TEXT_KEYS, *LIST_KEYS, *OTHER_KEYS))
        raise InputError(f"{place}: expected one of the keys {keys}, got {key!r}")
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


def _editable(entry: dict[str, Any], define: Sequence[tuple[str, Node]], place: str) -> tuple[str, ...]:
    """Return the parts of a claim that repairs may change: the parts in its key ``editable``, by default both sides."""
    parts = tuple(entry.get("editable", SIDES))
    known = (*SIDES, *(name for name, _ in define))
    for part in parts:
        if part not in known:
            raise InputError(f"{place}: editable: expected left, right or the name of a definition, got {part[:40]!r}")
    return parts


def _check_name(name: str, key: str, place: str) -> None:
    if not (name.isascii() and name.isidentifier() and name[0].isalpha()):
        raise InputError(f"{place}: {key}: expected a name of letters, digits and underscores, got {name[:40]!r}")
    if name in BUILT_IN or name in CONSTANTS:
        raise InputError(f"{place}: {key}: expected a name of your own, got {name!r}, which is built in")
