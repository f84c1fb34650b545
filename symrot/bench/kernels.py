"""Comparison of symrot's kernels with kernels of other tools: operations, and nanoseconds per sample.

    python -m symrot.bench.kernels [--rounds 63] [--many 1000000] [--kernels NAME ..] [--jacobians] [--count]

A contestant is one tool's version of a kernel, timed on single samples, a batch in the cache (shape ``cached``) and a
large batch (``many``). All alternate in one thread on the same memory.
"""

import argparse
import ctypes
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache, partial
from random import Random
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.bench.by_hand.kernel_drivers import drivers, heyoka_drivers
from symrot.bench.by_hand.kernel_heyoka import heyoka_code
from symrot.bench.by_hand.kernel_peers import PEERS_IN_C, casadi_function, casadi_text, counted, textbook
from symrot.build import cache as build_cache
from symrot.codegen.library_kernels import kernel_program
from symrot.codegen.printing.c_source import MATH_HEADER
from symrot.codegen.printing.math_header import math_header
from symrot.errors import InputError
from symrot.kernels.jacobian import BY, jacobian_name
from symrot.kernels.library import definition
from symrot.workshop.emit import Emitted, emit

__all__ = ["Contestant", "contest", "main"]

FLAGS = ("-std=c99", "-O3", build_cache.NATIVE, "-fno-math-errno", "-ffp-contract=fast", "-fno-tree-slp-vectorize",
         "-falign-functions=64", "-falign-loops=64", "-fPIC", "-fno-semantic-interposition", "-shared")  # fmt: skip
CACHED, MANY = 1000, 1_000_000  # numbers of samples; with a power of two, all arrays would compete for cache lines
PROPER = ("zxz", "zyz", "xyx", "xzx", "yxy", "yzy")
TAIT_BRYAN = ("zyx", "zxy", "xyz", "xzy", "yxz", "yzx")
PAGE = 4096  # bytes
PLACES = {"one": 1, "cached": 1, "many": 7}  # numbers of memory blocks between which rounds alternate
SHORTEST = 1e-3  # s, approximate duration of one measurement
BAR = 1.05  # largest accepted ratio of symrot's time to the least time of the other tools
OWN_START = "CasADi from symrot's program"

Floats = NDArray[np.float64]
SHAPES = ("one", "cached", "many")


@dataclass
class Contestant:
    """A kernel as one tool generates it: its operations, and times per sample, s, for each of the SHAPES of input."""

    name: str
    operations: Counter[str]
    runs: dict[str, Callable[[int], float]]  # shape -> function of a memory block's number that returns s per sample
    seconds: dict[str, list[float]] = field(default_factory=lambda: {shape: [] for shape in SHAPES})

    def nanoseconds(self, shape: str) -> float | None:
        """Return the least time per sample, ns, for a shape of input; None if it was not measured."""
        return min(self.seconds[shape]) * 1e9 if self.seconds[shape] else None


@cache
def _samples(name: str, count: int) -> list[Floats]:
    """Return ``count`` random inputs within a kernel's bounds, one array of shape (size, count) for each argument.

    Quaternions have unit norm.
    """
    kernel, draw = definition(name), np.random.default_rng(5)
    arrays = []
    for argument in kernel.inputs:
        box = [kernel.box[component] for component, *_ in argument.components]
        values = np.array([draw.uniform(float(low), float(high), count) for low, high in box])
        arrays.append(values / np.linalg.norm(values, axis=0) if argument.name == "q" else values)
    return arrays


@cache
def _block(name: str, shape: str, count: int, place: int) -> tuple[Floats, Floats]:
    """Return the arrays (inputs, outputs) of ``count`` samples, which all tools' versions of the kernel ``name`` use.

    A sample is a row of an array for the ``shape`` ``"one"``, and a column for batches. ``place`` is the number, from
    0, of the block of memory that contains the arrays: all blocks contain the same values.
    """
    samples = np.concatenate(_samples(name, count))
    size = sum(a.size for a in kernel_program(name).signature.arguments if a.role == "out")
    # One block from a page boundary, since the distance of inputs and outputs modulo a page changes the time. Place in
    # the caches is random and matters by up to 8 %, so there are several equal blocks, numbered ``place``.
    memory = np.empty((len(samples) + size) * count + PAGE)
    memory = memory[-memory.ctypes.data % PAGE // memory.itemsize :]
    apart = np.split(memory[: (len(samples) + size) * count], [samples.size])
    if shape == "one":
        inputs, outputs = (part.reshape(count, -1) for part in apart)
        inputs[:] = samples.T
    else:
        inputs, outputs = (part.reshape(-1, count) for part in apart)
        inputs[:] = samples
    outputs[:] = 0
    return inputs, outputs


def _addresses(name: str, shape: str, count: int, place: int) -> Any:
    """Return a C array with the address of each argument of the kernel ``name``.

    The arguments lie in the arrays (inputs, outputs) that ``_block(name, shape, count, place)`` returns.
    """
    addresses, offsets = [], {"in": 0, "out": 0}
    for argument in kernel_program(name).signature.arguments:
        block = _block(name, shape, count, place)[argument.role == "out"]
        part = slice(offsets[argument.role], None)
        addresses.append((block[:, part] if shape == "one" else block[part]).ctypes.data)
        offsets[argument.role] += argument.size
    return (ctypes.c_void_p * len(addresses))(*addresses)


def _timed(run: Callable[[int, int], object], samples: int) -> Callable[[int], float]:
    """Return a function ``measure(place)`` that times ``run(repeats, place)`` and returns seconds per sample.

    ``place`` is the number, from 0, of the block of memory with inputs and outputs (see :func:`_block`).
    """
    repeats, elapsed = 1, 0.0
    # repeats are doubled until the clock measures the time accurately; the first runs start with cold caches
    while elapsed < SHORTEST:
        repeats *= 2 if elapsed else 1
        began = perf_counter()
        run(repeats, 0)
        elapsed = perf_counter() - began

    def measure(place: int) -> float:
        start = perf_counter()
        run(repeats, place)
        return (perf_counter() - start) / (repeats * samples)

    return measure


def _in_c(
    name: str, text: str, many: int, prepare: Callable[[Any], object] = id
) -> tuple[dict[str, Callable[[int], float]], Floats]:
    """Compile the C ``text`` of the kernel ``name`` with its drivers; return timing functions and outputs.

    The timing functions are a dictionary by shape of input: one sample at a time (``"one"``), a batch small enough for
    the processor's cache (``"cached"``), and a batch of ``many`` samples (``"many"``; left out if the number is 0).
    Each returns seconds per sample; its argument is the number, from 0, of the block of memory with inputs and outputs,
    of which there are ``PLACES[shape]``. The outputs are those of the batch ``"cached"``. ``prepare`` is called with
    the loaded library.
    """
    loaded = ctypes.CDLL(str(build_cache.build(text, f"bench_{name}", FLAGS)))
    prepare(loaded)
    runs = {}
    for shape in SHAPES:
        count = many if shape == "many" else CACHED
        function = loaded.symrot_repeat_one if shape == "one" else loaded.symrot_repeat_batch
        function.argtypes = (ctypes.c_size_t, ctypes.c_size_t, ctypes.c_void_p)
        if count:
            addresses = [_addresses(name, shape, count, place) for place in range(PLACES[shape])]
            runs[shape] = _timed(partial(_call, function, count, addresses), count)
    runs["cached"](0)
    return runs, _block(name, "cached", CACHED, 0)[1].copy()


def _call(function: Any, count: int, addresses: Sequence[Any], repeats: int, place: int) -> None:
    function(repeats, count, addresses[place])


def _emitted(name: str) -> Emitted:
    base, *variables = name.split(BY)
    return emit(base, jacobian=variables)


def _symrot_text(name: str) -> str:
    emitted = _emitted(name)
    return emitted.source.replace(f'#include "{MATH_HEADER}"', math_header()).replace(
        f'#include "{name}.h"', emitted.header
    )


def _peers(name: str) -> tuple[dict[str, tuple[str, Counter[str]]], list[str]]:
    """Return a map from each tool but heyoka, such as CasADi, to its C text of a kernel and the operations in the text.

    The second result lists the tools that are not installed.
    """
    peers: dict[str, tuple[str, Counter[str]]] = {}
    missing = []
    for tool, make in PEERS_IN_C.items():
        try:
            if (text := make(name)) is not None:
                peers[tool] = text, counted(text, name)
        except ImportError:
            missing.append(tool)
    try:
        function, operations = casadi_function(name)
        peers["CasADi"] = casadi_text(function, kernel_program(name).signature), operations
    except ImportError:
        missing.append("CasADi")
    return peers, missing


def contest(name: str, many: int = MANY) -> tuple[list[Contestant], list[str]]:
    """Return the kernel ``name`` as symrot and as each other tool generates it, and the names of the missing tools.

    Symrot comes first. ``many`` is the number of samples of the larger batch. Raise AssertionError if the outputs of a
    tool differ from symrot's.
    """
    contestants: list[Contestant] = []
    signature = kernel_program(name).signature
    runs, reference = _in_c(name, _symrot_text(name) + drivers(signature, True), many)
    contestants.append(Contestant("symrot", counted(_emitted(name).source, name), runs))

    def add(tool: str, operations: Counter[str], runs: dict[str, Callable[[int], float]], outputs: Floats) -> None:
        error = float(np.max(np.abs(outputs - reference)) / np.max(np.abs(reference)))
        if not error < 1e-11:
            raise AssertionError(
                f"{tool}: expected outputs of {name} that agree with those of symrot, got outputs "
                f"that differ by {error:.1e}"
            )
        contestants.append(Contestant(tool, operations, runs))

    around = drivers(signature, False)
    peers, missing = _peers(name)
    for tool, (text, operations) in peers.items():
        add(tool, operations, *_in_c(name, f"#include <math.h>\n{text}{around}", many))
    try:
        code = heyoka_code(name)  # its sines have errors of up to 3.5 ulp
        add("heyoka", Counter(), *_in_c(name, heyoka_drivers(signature), many, prepare=lambda c: c.symrot_take(*code)))
    except ImportError:
        missing.append("heyoka")
    return contestants, missing


def measure(contestants: Sequence[Contestant], rounds: int) -> None:
    """Time the kernels of all tools, one after the other in each round, and append the times to ``seconds`` of each."""
    draw = Random(5)
    for number in range(rounds):
        # The previous contestant fills the caches, so the order changes.
        for contestant in draw.sample(contestants, len(contestants)):
            for shape, run in contestant.runs.items():
                contestant.seconds[shape].append(run(number % PLACES[shape]))


def _line(contestant: Contestant) -> str:
    counts = contestant.operations
    operations = (
        ", ".join(f"{counts[kind]} {kind}" for kind in ("mul", "add", "div", "sin", "cos") if counts[kind]) or "-"
    )
    total = f"{sum(counts.values())}: " if counts else ""
    times = (contestant.nanoseconds(shape) for shape in SHAPES)
    return f"  {contestant.name:10} {total + operations:38}" + "".join(
        f"{t:10.2f}" if t else f"{'-':>10}" for t in times
    )


def _operations(contestants: Sequence[Contestant]) -> tuple[int, int]:
    """Return the number of operations of symrot's kernel, and the smallest number among the other tools.

    ``contestants[0]`` is symrot.
    """
    mine, *others = (sum(c.operations.values()) for c in contestants if c.operations)
    return mine, min(others)


def _ratios(contestants: Sequence[Contestant]) -> dict[str, float]:
    """Return, for each shape of input, the ratio of symrot's time to that of the fastest other tool.

    The time of a tool is its least time of all rounds. For the shape ``"many"``, the ratios of symrot's time to that of
    each other tool are computed within each round, and their median is taken for each tool. The result is then the
    largest of these medians.
    """
    own, *others = contestants
    ratios = {}
    for shape in SHAPES:
        rivals = [c.seconds[shape] for c in others if c.seconds[shape]]
        mine = own.seconds[shape]
        if mine and shape == "many":
            # Other processes use the memory too: compare within each round, take the median.
            ratios[shape] = max(float(np.median(np.divide(mine, each))) for each in rivals)
        elif mine:
            ratios[shape] = min(mine) / min(map(min, rivals))
    return ratios


def _table(name: str, contestants: Sequence[Contestant]) -> list[str]:
    """Return the lines of the table for the kernel ``name``: one for each contestant, and one with ratios.

    The ratios are, for each shape of input, symrot's time divided by the time of the fastest other tool.
    """
    parts = [f"operations {mine} to {best}" for mine, best in (_operations(contestants),)]
    parts += [f"{shape} {ratio:.2f}" for shape, ratio in _ratios(contestants).items()]
    return [
        f"{name:51}" + "".join(f"{shape:>10}" for shape in SHAPES),
        *map(_line, contestants),
        f"  symrot divided by the best of the others: {', '.join(parts)}",
    ]


def _missed(name: str, contestants: Sequence[Contestant]) -> list[str]:
    """Return texts that say where symrot needs more operations than the best tool, or more than 1.05 times its time."""
    mine, best = _operations(contestants)
    over = [f"{name} {shape} {ratio:.3f}" for shape, ratio in _ratios(contestants).items() if ratio > BAR]
    return [f"{name} operations {mine} to {best}"] * (mine > best) + over


def counts(name: str) -> tuple[dict[str, Counter[str]], list[str]]:
    """Return how many operations of each kind a kernel needs in each tool, and the names of the missing tools.

    Example: ``{"symrot": {"mul": 12, "add": 9}, ..}``.
    """
    peers, missing = _peers(name)
    operations = {"symrot": counted(_emitted(name).source, name)}
    operations |= {tool: count for tool, (_, count) in peers.items()}
    # CasADi may also differentiate symrot's own program instead of the textbook's formulas.
    if BY in name and "CasADi" in peers:
        operations[OWN_START] = casadi_function(name, kernel_program)[1]
    return operations, missing


def _count(names: Sequence[str]) -> None:
    """Print how many operations each tool needs for each kernel, and the kernels for which symrot needs more."""
    over, absent = [], set[str]()
    for name in names:
        operations, missing = counts(name)
        absent |= set(missing)
        totals = {tool: count.total() for tool, count in operations.items()}
        print(f"{name}: {', '.join(f'{tool} {total}' for tool, total in totals.items())}", flush=True)
        over += [f"{name} {totals['symrot']} to {totals[tool]} of {tool}" for tool in totals
                 if totals[tool] < totals["symrot"]]  # fmt: skip
    print(f"not installed, left out: {', '.join(sorted(absent))}" if absent else "every tool took part")
    print(f"fewer operations than symrot: {'; '.join(over) or 'none'}")


def main(arguments: list[str] | None = None) -> None:
    """Print, for each kernel, operations and times of symrot and of the other tools."""
    parser = argparse.ArgumentParser(prog="python -m symrot.bench.kernels", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--rounds", type=int, default=63)
    parser.add_argument("--many", type=int, default=MANY, help="number of samples in the large batch; 0 omits it")
    parser.add_argument(
        "--kernels",
        nargs="+",
        metavar="NAME",
        help="kernels to compare (default: those in the table of the benchmark's report)",
    )
    parser.add_argument("--jacobians", action="store_true", help="compare kernels that compute derivatives too")
    parser.add_argument("--count", action="store_true", help="count operations only")
    options = parser.parse_args(arguments)
    rates = [f"euler_{sequence}_body_rates" for sequence in (*PROPER, *TAIT_BRYAN)]
    variables = {"quaternion_dcm": ("q",)} | dict.fromkeys(rates, ("angles", "omega"))
    variables |= dict.fromkeys(("rigid_body_tensor", "heavy_top"), ("omega", "q"))
    table = [jacobian_name(name, by if options.jacobians else ()) for name, by in variables.items()]
    names = options.kernels or table
    try:
        for name in names:
            textbook(name)
    except InputError as error:
        parser.error(f"--kernels: {error}")
    if options.count:
        return _count(names)
    print(f"ns per sample: one at a time, {CACHED} in a batch, {options.many} in a batch; {' '.join(FLAGS[1:6])}")
    absent: set[str] = set()
    cells, over = 0, []
    for name in names:
        contestants, missing = contest(name, options.many)
        absent |= set(missing)
        measure(contestants, options.rounds)
        print("\n".join(_table(name, contestants)), flush=True)
        cells += 1 + len(_ratios(contestants))
        over += _missed(name, contestants)
        _block.cache_clear()
        _samples.cache_clear()
    print(f"not installed, left out: {', '.join(sorted(absent))}" if absent else "every tool took part")
    print(f"{cells - len(over)} of {cells} cells within the limit (operations: no more than the best other tool; ns: "
          f"at most {BAR} times those of the fastest); over it: {'; '.join(over) or 'none'}")  # fmt: skip


if __name__ == "__main__":
    main()
