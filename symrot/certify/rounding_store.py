"""What was bounded once: kept in memory, and in the cache by what it depends on, the method included."""

import hashlib
import json
from dataclasses import asdict
from functools import cache
from pathlib import Path

from symrot.certify.rounding_subdivision import Search
from symrot.codegen import library

__all__ = ["Store"]

_METHOD = ("intervals", "functions", "cone", "centred", "adjoint", "subdivision")
_NUMBERS = ("bound", "pointwise", "largest_value")


@cache
def _method() -> str:
    """Return the SHA-256 of the method's own sources: another method, other bounds."""
    here = Path(__file__).parent
    return hashlib.sha256(b"".join((here / f"rounding_{name}.py").read_bytes() for name in _METHOD)).hexdigest()


class Store:
    """Bounds by key."""

    def __init__(self) -> None:
        self.memory: dict[str, Search] = {}

    def get(self, key: str) -> Search | None:
        """Return the bound of a key, or None."""
        if key not in self.memory:
            text = library.fetch(f"rounding {_method()} {key}")
            if text is None:
                return None
            found = json.loads(text)
            found["worst"] = tuple(map(float.fromhex, found["worst"]))
            self.memory[key] = Search(**found | {name: float.fromhex(found[name]) for name in _NUMBERS})
        return self.memory[key]

    def put(self, key: str, found: Search) -> None:
        """Keep the bound of a key."""
        self.memory[key] = found
        data = asdict(found) | {name: getattr(found, name).hex() for name in _NUMBERS}
        library.store(f"rounding {_method()} {key}", json.dumps(data | {"worst": [x.hex() for x in found.worst]}))
