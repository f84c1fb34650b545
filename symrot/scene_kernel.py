"""The kernels of one plan as saved data: rates, quantities, what is kept, and the C text. No SymPy.

:mod:`symrot.codegen.scene_kernels` derives it; the cache keeps it as JSON; the propagator binds it to numbers.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NamedTuple

from symrot import number
from symrot.expression import Node, evaluate
from symrot.kernel import Program, node_from_json, node_to_json

__all__ = ["Conserved", "SceneKernel", "bind"]

EXACT_FUNCTIONS = {"sqrt": number.sqrt, "sin": number.sin, "cos": number.cos, "abs": abs}


class Conserved(NamedTuple):
    """A candidate for a conserved quantity: name, unit, the output that holds it, whether it is kept, and why."""

    name: str
    unit: str
    output: str
    kept: bool
    reason: str


@dataclass(frozen=True)
class SceneKernel:
    """What is derived once for a structure and used for every scene that has it."""

    rates: Program
    rate_parameters: tuple[tuple[str, Node], ...]
    quantities: Program
    quantity_parameters: tuple[tuple[str, Node], ...]
    conserved: tuple[Conserved, ...]
    source: str  # C text of the rates

    def to_json(self) -> dict[str, Any]:
        """Return plain data from which :meth:`from_json` makes an equal kernel."""
        return {
            "rates": self.rates.to_json(),
            "rate_parameters": [[name, node_to_json(node)] for name, node in self.rate_parameters],
            "quantities": self.quantities.to_json(),
            "quantity_parameters": [[name, node_to_json(node)] for name, node in self.quantity_parameters],
            "conserved": [list(item) for item in self.conserved],
            "source": self.source,
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "SceneKernel":
        """Return the kernel that :meth:`to_json` saved."""
        return cls(
            Program.from_json(data["rates"]),
            tuple((name, node_from_json(node)) for name, node in data["rate_parameters"]),
            Program.from_json(data["quantities"]),
            tuple((name, node_from_json(node)) for name, node in data["quantity_parameters"]),
            tuple(Conserved(*item) for item in data["conserved"]),
            data["source"],
        )


def bind(parameters: tuple[tuple[str, Node], ...], constants: Mapping[str, Fraction]) -> list[float]:
    """Return the parameters of a kernel for the constants of a scene: exact arithmetic, one rounding each."""
    values = {"pi": number.PI, **constants}
    return [float(evaluate(node, values, EXACT_FUNCTIONS)) for _, node in parameters]
