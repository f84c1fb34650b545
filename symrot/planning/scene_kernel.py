"""Kernels of scenes as saved data: a kernel consists of the equations of a scene's plan as programs, and their C text.

A program is a list of arithmetic operations without branches, and can be printed as C or as Python. The cache stores
kernels as JSON, and the propagator assigns values to their parameters. No SymPy.
"""

from collections.abc import Mapping
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple, TypedDict

from symrot.formula import exact_numbers as number
from symrot.formula.exact_functions import EXACT_FUNCTIONS
from symrot.formula.program import Program, ProgramRecord, node_from_json, node_to_json
from symrot.formula.tree import Node, evaluate

__all__ = ["EPOCH", "Conserved", "KernelRecord", "Parameters", "SceneKernel", "bind"]

EPOCH = "epoch"  # name in formulas of parameters: the time of the scene, s, at which a moved clock shows 0

Parameters = tuple[tuple[str, Node], ...]  # name in the kernel, formula over the physical constants


class Conserved(NamedTuple):
    """A candidate for a conserved quantity, with the decision of whether it is conserved.

    Attributes
    ----------
    name, unit : str
        Name and SI unit of the quantity.
    output : str
        Name of the output of the kernel that computes the quantity; it may be empty if ``holds`` is false.
    holds : bool
        Whether the quantity is conserved.
    reason : str
        The reason why the quantity is conserved or not.
    """

    name: str
    unit: str
    output: str
    holds: bool
    reason: str


SavedParameters = list[tuple[str, list[Any]]]  # name, formula as nested lists


class KernelRecord(TypedDict):
    """The data of a :class:`SceneKernel`, which the cache stores as JSON; each key is a property of that class."""

    rates: ProgramRecord
    rate_parameters: SavedParameters
    quantities: ProgramRecord
    quantity_parameters: SavedParameters
    conserved: list[tuple[str, str, str, bool, str]]  # the fields of Conserved
    source: str


class SceneKernel:
    """The equations of motion of all scenes of one structure, derived once and ready to be evaluated.

    A structure says which constants of body and torques are zero, one, equal or free (any other value).

    Examples
    --------
    >>> import symrot
    >>> "symrot_rates" in symrot.propagator("t_handle").kernel.source
    True
    """

    def __init__(self, record: KernelRecord) -> None:
        # Programs are restored on first use: a propagation in C never needs the program of the rates.
        self.record = record

    @classmethod
    def of(
        cls, rates: Program, rate_parameters: Parameters, quantities: Program, quantity_parameters: Parameters,
        conserved: tuple[Conserved, ...], source: str,
    ) -> "SceneKernel":  # fmt: skip
        """Return the kernel of the given programs, parameters and conserved quantities; ``source``: C text of rates."""
        return cls(
            {
                "rates": rates.to_json(),
                "rate_parameters": _saved(rate_parameters),
                "quantities": quantities.to_json(),
                "quantity_parameters": _saved(quantity_parameters),
                "conserved": [(item.name, item.unit, item.output, item.holds, item.reason) for item in conserved],
                "source": source,
            }
        )

    def without_invariants(self, reason: str) -> "SceneKernel":
        """Return the kernel with all candidates for conserved quantities marked as not conserved, for ``reason``.

        Nothing can be proven, for example, about a torque without a formula.
        """
        lost = [(name, unit, output, False, reason) for name, unit, output, *_ in self.record["conserved"]]
        return SceneKernel({**self.record, "conserved": lost})

    @cached_property
    def rates(self) -> Program:
        """The program that computes ``dy/dt``, the rates (time derivatives) of the states y."""
        return Program.from_json(self.record["rates"])

    @cached_property
    def rate_parameters(self) -> Parameters:
        """The parameters of :attr:`rates`, in the order of the array that the C function takes.

        Each is a pair (name, formula in the scene's constants), such as ``("p0", (B - C)/A)``.
        """
        return _loaded(self.record["rate_parameters"])

    @cached_property
    def quantities(self) -> Program:
        """The program that computes omega, attitude, momentum, energy and conserved quantities from the states."""
        return Program.from_json(self.record["quantities"])

    @cached_property
    def quantity_parameters(self) -> Parameters:
        """The parameters of :attr:`quantities`, in order, as pairs (name, formula in the scene's constants)."""
        return _loaded(self.record["quantity_parameters"])

    @cached_property
    def conserved(self) -> tuple[Conserved, ...]:
        """The candidates for conserved quantities, such as the energy; those that are conserved come first."""
        return tuple(Conserved(*item) for item in self.record["conserved"])

    @property
    def source(self) -> str:
        """The C text of the rates: the function ``symrot_rates``.

        One of its arguments is the array of the parameters, even if the rates have no parameters.
        """
        return self.record["source"]


def _saved(parameters: Parameters) -> SavedParameters:
    return [(name, node_to_json(node)) for name, node in parameters]


def _loaded(saved: SavedParameters) -> Parameters:
    return tuple((name, node_from_json(node)) for name, node in saved)


def bind(parameters: Parameters, constants: Mapping[str, Fraction]) -> list[float]:
    """Return the values of parameters, pairs (name, formula), for exact constants, each rounded to a double.

    Sums, products and quotients are exact; pi and functions such as sin have more than 60 digits.
    """
    values = {"pi": number.PI, **constants}
    return [float(evaluate(node, values, EXACT_FUNCTIONS)) for _, node in parameters]
