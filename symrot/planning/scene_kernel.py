"""The kernels of one plan as saved data: rates, quantities, what is kept, and the C text. No SymPy.

:mod:`symrot.codegen.scene_kernels` derives it; the cache keeps it as JSON; the propagator binds it to numbers.
"""

from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

from symrot.formula import exact_numbers as number
from symrot.formula.program import Program, node_from_json, node_to_json
from symrot.formula.tree import Node, evaluate

__all__ = ["EPOCH", "EXACT_FUNCTIONS", "Conserved", "Parameters", "SceneKernel", "bind"]

EXACT_FUNCTIONS: dict[str, Callable[..., Fraction]] = {
    "sqrt": number.sqrt,
    "sin": number.sin,
    "cos": number.cos,
    "abs": abs,
    "without_turns": number.without_turns,
}
EPOCH = "epoch"  # of formulas of parameters: the time, s, that the clock of a moved kernel calls 0

Parameters = tuple[tuple[str, Node], ...]  # name in the kernel, formula over the physical constants


class Conserved(NamedTuple):
    """A candidate for a conserved quantity: name, unit, the output that holds it, whether it is kept, and why."""

    name: str
    unit: str
    output: str
    kept: bool
    reason: str


class SceneKernel:
    """What is derived once for a structure and used for every scene that has it.

    Programs are made from the saved data when they are first used: a propagation in C never needs the rates.

    Examples
    --------
    >>> import symrot
    >>> "symrot_rates" in symrot.propagator("t_handle").kernel.source
    True
    """

    def __init__(self, data: Mapping[str, Any]) -> None:
        self.data = data

    @classmethod
    def of(
        cls, rates: Program, rate_parameters: Parameters, quantities: Program, quantity_parameters: Parameters,
        conserved: tuple[Conserved, ...], source: str,
    ) -> "SceneKernel":  # fmt: skip
        """Return the kernel of freshly derived programs."""
        return cls(
            {
                "rates": rates.to_json(),
                "rate_parameters": _saved(rate_parameters),
                "quantities": quantities.to_json(),
                "quantity_parameters": _saved(quantity_parameters),
                "conserved": [list(item) for item in conserved],
                "source": source,
            }
        )

    @cached_property
    def rates(self) -> Program:
        """``dy/dt`` of the states."""
        return Program.from_json(self.data["rates"])

    @cached_property
    def rate_parameters(self) -> Parameters:
        """What the parameters of the rates are."""
        return _loaded(self.data["rate_parameters"])

    @cached_property
    def quantities(self) -> Program:
        """Angular velocity, attitude, momentum, energy and what is conserved, of time and states."""
        return Program.from_json(self.data["quantities"])

    @cached_property
    def quantity_parameters(self) -> Parameters:
        """What the parameters of the quantities are."""
        return _loaded(self.data["quantity_parameters"])

    @cached_property
    def conserved(self) -> tuple[Conserved, ...]:
        """The candidates for conserved quantities, those that are kept first."""
        return tuple(Conserved(*item) for item in self.data["conserved"])

    @property
    def source(self) -> str:
        """C text of the rates, the function ``symrot_rates``, taking parameters even if it has none."""
        return str(self.data["source"])


def _saved(parameters: Parameters) -> list[Any]:
    return [[name, node_to_json(node)] for name, node in parameters]


def _loaded(data: list[Any]) -> Parameters:
    return tuple((name, node_from_json(node)) for name, node in data)


def bind(parameters: Parameters, constants: Mapping[str, Fraction]) -> list[float]:
    """Return the parameters of a kernel for the constants of a scene: exact arithmetic, one rounding each."""
    values = {"pi": number.PI, **constants}
    return [float(evaluate(node, values, EXACT_FUNCTIONS)) for _, node in parameters]
