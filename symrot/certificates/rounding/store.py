"""What was bounded once: in memory, in the table that comes with symrot, in the cache.

The table, ``rounding_bounds.json``, holds the bounds of the library on its boxes, so that kernels are emitted with
them at once; ``python -m symrot.workshop.bound_table`` prints it anew. A bound is filed under what it is of: the
operations behind an output, the box, the region, the budget, the error of libm
(:class:`~symrot.certificates.rounding.bounds.Task`).
"""

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

from symrot.build import cache as library
from symrot.certificates.rounding.branch_and_bound import Search

__all__ = ["TABLE", "Store", "method", "printed_table", "table"]

TABLE = Path(__file__).with_name("bounds.json")
_METHOD = ("intervals", "functions", "output_graph", "region", "choices", "centred", "adjoint", "branch_and_bound")
_NUMBERS = ("bound", "pointwise", "largest_value")


@cache
def method() -> str:
    """Return the SHA-256 of the method's own sources: another method, other bounds."""
    here = Path(__file__).parent
    return hashlib.sha256(b"".join((here / f"{name}.py").read_bytes() for name in _METHOD)).hexdigest()


@cache
def table() -> Mapping[str, Any]:
    """Return the table that comes with symrot: the method it was found by, and key -> bound, both as plain data."""
    try:
        return dict(json.loads(TABLE.read_text(encoding="utf-8")))
    except OSError:
        return {"method": "", "bounds": {}}


def printed_table(found: Iterable[tuple[str, Search]]) -> str:
    """Return the text of a table of bounds, one on a line, in the order of their keys."""
    rows = [f'  "{key}": {json.dumps(_plain(search))}' for key, search in sorted(dict(found).items())]
    return f'{{\n "method": "{method()}",\n "bounds": {{\n' + ",\n".join(rows) + "\n }\n}\n"


def _plain(found: Search) -> dict[str, Any]:
    numbers = {name: getattr(found, name).hex() for name in _NUMBERS}
    return asdict(found) | numbers | {"worst": [x.hex() for x in found.worst]}


def _search(plain: Mapping[str, Any]) -> Search:
    numbers = {name: float.fromhex(plain[name]) for name in _NUMBERS}
    return Search(**{**plain, **numbers, "worst": tuple(map(float.fromhex, plain["worst"]))})


class Store:
    """Bounds by key."""

    def __init__(self) -> None:
        self.memory: dict[str, Search] = {}

    def get(self, key: str, with_table: bool = True) -> Search | None:
        """Return the bound of a key, or None; ``with_table``: also one that came with symrot."""
        if with_table and key in table()["bounds"]:
            return _search(table()["bounds"][key])
        if key not in self.memory:
            text = library.fetch(f"rounding {method()} {key}")
            if text is None:
                return None
            self.memory[key] = _search(json.loads(text))
        return self.memory[key]

    def put(self, key: str, found: Search) -> None:
        """Keep the bound of a key."""
        self.memory[key] = found
        library.store(f"rounding {method()} {key}", json.dumps(_plain(found)))
