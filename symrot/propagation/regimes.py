"""The smooth motions between switches, and the guards that end them; see :mod:`symrot.propagation.switched`."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

from symrot.codegen import library
from symrot.expression import names, parse, rename, text
from symrot.kernel import Argument, Program
from symrot.propagation.binding import two_doubles, value_of
from symrot.propagation.events import Event, guard_library_source
from symrot.propagation.kernels import error_blocks
from symrot.propagation.motion import Motion
from symrot.scene_kernel import SceneKernel, bind

if TYPE_CHECKING:
    from symrot.propagation.switched import SwitchedMotion

__all__ = ["Guard", "Modes", "Regime"]

Modes = dict[str, int]


class Guard(NamedTuple):
    """A formula that is positive as long as its switch keeps its mode, and the change of the mode where it is not."""

    mode: str
    formula: str
    change: int  # 0: to the opposite sign; 1, -1: to that side, or by that much
    where: tuple[str, int] | None


class Regime:
    """The smooth motion while some guards stay at zero, and the guards that end it."""

    def __init__(self, switched: "SwitchedMotion", motion: Motion, held: frozenset[str]) -> None:
        self.motion, self.plan, self.held, self.constants = motion, motion.plan, held, switched.constants
        self.guards = [guard for switch in switched.switches for guard in self._guards(switch)]
        known = {*self.constants, *(switch["mode"] for switch in switched.switches)}
        nodes = [parse(guard.formula) for guard in self.guards]
        self.more = sorted(known & set().union(*map(names, nodes)))
        self.events = [Event(guard.formula, terminal=True, direction=-1) for guard in self.guards]
        columns = {name: f"{name} of the scene" for name in self.more}  # a kernel has names of its own for constants
        columns |= {f"{mode}_of_t": f"{mode} of t" for mode in held}
        program = _with_parameters(motion.kernel.quantities, [columns[name] for name in self.more])
        formulas = [rename(node, columns) for node in nodes]
        source = guard_library_source(program, formulas, self.plan.states, *error_blocks(self.plan))
        self.path = library.build(source, "events")
        self._bound: dict[tuple[int, ...], tuple[list[float], list[float]]] = {}

    def _guards(self, switch: Mapping[str, Any]) -> Iterator[Guard]:
        mode, where = switch["mode"], switch["where"]
        if mode in self.held:
            yield Guard(mode, f"1 - {mode}_of_t", 1, where)
            yield Guard(mode, f"1 + {mode}_of_t", -1, where)
        elif switch["kind"] == "sign":
            yield Guard(mode, f"{mode}*({text(switch['guard'])})", 0, where)
        else:
            yield Guard(mode, f"({text(switch['guard'])}) - {mode}", -1, where)
            yield Guard(mode, f"{mode} + 1 - ({text(switch['guard'])})", 1, where)

    def bound(self, modes: Modes) -> tuple[list[float], list[float]]:
        """Return the parameters of the stepper's library and of the guards' for some modes."""
        key = tuple(modes.values())
        if key not in self._bound:
            constants = {**self.constants, **{name: Fraction(value) for name, value in modes.items()}}
            kernel: SceneKernel = self.motion.kernel
            rates = bind(kernel.rate_parameters, constants)
            if self.motion.choice.method == "taylor":
                for _, node in kernel.quantity_parameters:  # of these modes: with others some have no value
                    rates += two_doubles(*value_of(node, constants).as_integer_ratio())
            guards = [*bind(kernel.quantity_parameters, constants), *(float(constants[name]) for name in self.more)]
            self._bound[key] = rates, guards
        return self._bound[key]

    def active(self, modes: Modes) -> list[bool]:
        """Return which guards matter."""
        return [guard.where is None or modes[guard.where[0]] == guard.where[1] for guard in self.guards]


def _with_parameters(program: Program, more: list[str]) -> Program:
    """Return a program with further parameters, which its outputs do not use."""
    arguments = list(program.signature.arguments)
    place = next((k for k, argument in enumerate(arguments) if argument.name == "p"), None)
    extra = tuple((name, "", "") for name in more)
    if place is None:
        arguments.insert(2, Argument("p", "in", extra))
    else:
        arguments[place] = replace(arguments[place], components=(*arguments[place].components, *extra))
    return replace(program, signature=replace(program.signature, arguments=tuple(arguments)))
