"""The store of rounding bounds: in memory, in the table that comes with symrot, and in the user's cache.

The table ``bounds.json`` holds the bounds of the library's kernels, printed by ``python -m
symrot.workshop.bound_table``. The key of a bound is a hash of its task: operations, box, region, budget and error of
libm.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

from symrot.build import cache as cache_files
from symrot.build.code_digest import code_digest
from symrot.certificates.rounding.branch_and_bound import SearchResult

__all__ = ["TABLE", "Store", "method", "printed_table", "table"]

TABLE = Path(__file__).with_name("bounds.json")
_METHOD = ("intervals", "functions", "output_graph", "region", "choices", "centred", "adjoint", "branch_and_bound")
_NUMBERS = ("bound", "pointwise", "largest_value")


@cache
def method() -> str:
    """Return the SHA-256 of the source files that compute bounds (the "method"), without docstrings and comments."""
    # part of the key of each bound in the user's cache, so that a bound by other code is not used
    return code_digest(Path(__file__).with_name(f"{name}.py").read_text(encoding="utf-8") for name in _METHOD)


@cache
def table() -> Mapping[str, Any]:
    """Return the content of ``bounds.json``, the rounding error bounds that come with symrot.

    ``"bounds"`` maps a key, the hash of what is bounded (operations, box, budget ..), to the bound as data for JSON.
    ``"method"`` is the hash of the code that computed the bounds. If the file is missing, there are no bounds.
    """
    try:
        return dict(json.loads(TABLE.read_text(encoding="utf-8")))
    except OSError:
        return {"method": "", "bounds": {}}


def printed_table(bounds: Iterable[tuple[str, SearchResult]]) -> str:
    """Return the text of ``bounds.json``, the rounding error bounds that come with symrot, from pairs (key, bound).

    There is one bound per line, sorted by key. A key is the hash of what is bounded (operations, box, budget ..).
    """
    rows = [f'  "{key}": {json.dumps(_to_json(bound))}' for key, bound in sorted(dict(bounds).items())]
    return f'{{\n "method": "{method()}",\n "bounds": {{\n' + ",\n".join(rows) + "\n }\n}\n"


def _to_json(bound: SearchResult) -> dict[str, Any]:
    numbers = {name: getattr(bound, name).hex() for name in _NUMBERS}
    return asdict(bound) | numbers | {"worst": [x.hex() for x in bound.worst]}


def _from_json(plain: Mapping[str, Any]) -> SearchResult:
    numbers = {name: float.fromhex(plain[name]) for name in _NUMBERS}
    return SearchResult(**{**plain, **numbers, "worst": tuple(map(float.fromhex, plain["worst"]))})


class Store:
    """A store of rounding error bounds: in memory, in the table that comes with symrot, and in the user's cache."""

    def __init__(self) -> None:
        self.memory: dict[str, SearchResult] = {}

    def get(self, key: str, with_table: bool = True) -> SearchResult | None:
        """Return the bound stored under a key, or None if there is no such bound.

        If ``with_table`` is false, the table of bounds that comes with symrot is not searched.
        """
        if with_table and key in table()["bounds"]:
            return _from_json(table()["bounds"][key])
        if key not in self.memory:
            text = cache_files.fetch(f"rounding {method()} {key}")
            if text is None:
                return None
            self.memory[key] = _from_json(json.loads(text))
        return self.memory[key]

    def put(self, key: str, bound: SearchResult) -> None:
        """Store a bound of a rounding error under its key, in memory and in the cache."""
        self.memory[key] = bound
        cache_files.store(f"rounding {method()} {key}", json.dumps(_to_json(bound)))
