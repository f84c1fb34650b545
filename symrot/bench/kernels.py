"""Measure kernels against those of other tools: operations, ns for one sample, in a batch in cache, in one of 10^6.

    python -m symrot.bench.kernels [--rounds 15] [--many 1000000] [--kernels NAME ..]

All contestants take turns in one run and compute the same numbers, which is checked. What makes C is compiled with the
same compiler and flags. heyoka's functions and CasADi's own evaluation are called from Python: a batch of 1000 counts
by what it takes longer than a batch of one, so that the call is not held against them.
"""

import argparse
import ctypes
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.bench.kernel_peers import PEERS_IN_C, casadi_function, counted, heyoka_function
from symrot.codegen import library
from symrot.codegen.c_source import MATH_HEADER
from symrot.codegen.library_kernels import kernel_program
from symrot.codegen.math_header import math_header
from symrot.interface import emit
from symrot.kernel import Signature
from symrot.kernels.library import definition

__all__ = ["Contestant", "contest", "main"]

FLAGS = ("-std=c99", "-O3", library.NATIVE, "-fno-math-errno", "-ffp-contract=fast", "-fno-tree-slp-vectorize", "-fPIC",
         "-fno-semantic-interposition", "-shared")  # fmt: skip
CACHED, MANY = 1000, 1_000_000  # no power of two, at which all arrays would share cache lines
PROPER = ("zxz", "zyz", "xyx", "xzx", "yxy", "yzy")
TAIT_BRYAN = ("zyx", "zxy", "xyz", "xzy", "yxz", "yzx")
SHORTEST = 1e-3  # s, one measurement

Floats = NDArray[np.float64]
SHAPES = ("one", "cached", "many")


@dataclass
class Contestant:
    """One way to compute a kernel: its operations, and the seconds per sample of each shape, round by round."""

    name: str
    operations: Counter[str]
    runs: dict[str, Callable[[], float]]  # shape -> run it once, return seconds per sample
    seconds: dict[str, list[float]] = field(default_factory=lambda: {shape: [] for shape in SHAPES})

    def nanoseconds(self, shape: str) -> float | None:
        """Return the least time per sample in ns, None where it was not measured."""
        return (
            (self.seconds[shape][-1] if self.name == "heyoka" and shape == "cached" else min(self.seconds[shape])) * 1e9
            if self.seconds[shape]
            else None
        )


def _samples(name: str, count: int) -> list[Floats]:
    """Return inputs in the box of a kernel, one array of shape (size, count) for each argument; unit quaternions."""
    found, draw = definition(name), np.random.default_rng(5)
    arrays = []
    for argument in found.inputs:
        box = [found.box[component] for component, *_ in argument.components]
        values = np.array([draw.uniform(float(low), float(high), count) for low, high in box])
        arrays.append(values / np.linalg.norm(values, axis=0) if argument.name == "q" else values)
    return arrays


@cache
def _arrays(name: str, shape: str, count: int) -> list[Floats]:
    """Return inputs and outputs, the same for all contestants: where they lie in memory matters."""
    outputs = [a for a in kernel_program(name).signature.arguments if a.role == "out"]
    given, found = _samples(name, count), [np.zeros((a.size, count)) for a in outputs]
    if shape == "one":
        return [np.ascontiguousarray(array.T) for array in [*given, *found]]
    return [*given, *found]


def _drivers(signature: Signature, batch: bool) -> str:
    """Return C that repeats a one-sample function over samples, and a batch; the batch too, where there is none."""
    inputs = [a for a in signature.arguments if a.role == "in"]
    outputs = [a for a in signature.arguments if a.role == "out"]
    every = [*inputs, *outputs]
    one = ", ".join(f"a[{i}][k]" if a.is_scalar else f"a[{i}] + {a.size}*k" for i, a in enumerate(every))
    lines = []
    if not batch:
        pointers = [f"{'const ' if a in inputs else ''}double *restrict {a.name}" for a in every]
        loaded = [f"{a.name}[{f'{i}*n + ' if not a.is_scalar else ''}k]" for a in inputs for i in range(a.size)]
        local = iter(loaded)
        lines += [f"void batch(size_t n, {', '.join(pointers)})", "{", "    _Pragma(\"GCC ivdep\")",
                  "    for (size_t k = 0; k < n; ++k) {"]  # fmt: skip
        for a in inputs:
            values = ", ".join(next(local) for _ in range(a.size))
            lines.append(f"        const double {a.name}_k{'' if a.is_scalar else f'[{a.size}]'} = "
                         + (values if a.is_scalar else f"{{{values}}}") + ";")  # fmt: skip
        lines += [f"        double {a.name}_k[{a.size}];" for a in outputs]
        lines.append(f"        {signature.name}({', '.join(f'{a.name}_k' for a in every)});")
        lines += [f"        {a.name}[{i}*n + k] = {a.name}_k[{i}];" for a in outputs for i in range(a.size)]
        lines += ["    }", "}"]
    called = f"{signature.name}_batch" if batch else "batch"
    taken = [f"{'const ' if a in inputs else ''}double {'' if a.is_scalar else '*'}{a.name}" for a in every]
    lines += [f"static __attribute__((noinline)) void single({', '.join(taken)})", "{",
              f"    {signature.name}({', '.join(a.name for a in every)});", "}"]  # fmt: skip
    arguments = ", ".join(f"a[{i}]" for i in range(len(every)))
    return "\n".join([
        "#include <stddef.h>", *lines,
        "void repeat_one(size_t repeats, size_t n, double **a)", "{",
        "    for (size_t r = 0; r < repeats; ++r)", "        for (size_t k = 0; k < n; ++k) {",
f"            single({one});",
        '            __asm__ volatile("" ::: "memory"); /* one sample at a time */', "        }", "}",
        "void repeat_batch(size_t repeats, size_t n, double **a)", "{",
        "    for (size_t r = 0; r < repeats; ++r) {", f"        {called}(n, {arguments});",
        '        __asm__ volatile("" ::: "memory");', "    }", "}",
    ]) + "\n"  # fmt: skip


def _addresses(arrays: Sequence[Floats]) -> Any:
    return (ctypes.c_void_p * len(arrays))(*(array.ctypes.data for array in arrays))


def _timed(run: Callable[[int], object], samples: int) -> Callable[[], float]:
    """Return a measurement: seconds per sample of ``run(repeats)``, repeated until the clock can see it."""
    began = perf_counter()
    run(1)
    repeats = max(1, int(SHORTEST / max(perf_counter() - began, 1e-7)))

    def measure() -> float:
        start = perf_counter()
        run(repeats)
        return (perf_counter() - start) / (repeats * samples)

    return measure


def _repeated(function: Any, count: int, arrays: Sequence[Floats]) -> Callable[[int], object]:
    addresses = _addresses(arrays)

    def run(repeats: int, kept: Sequence[Floats] = arrays) -> None:  # the arrays live as long as the run
        function(repeats, count, addresses)

    return run


def _in_c(name: str, text: str, batch: bool, many: int) -> tuple[dict[str, Callable[[], float]], list[Floats]]:
    signature = kernel_program(name).signature
    loaded = ctypes.CDLL(str(library.build(text + _drivers(signature, batch), f"bench_{name}", FLAGS)))
    outputs = [a for a in signature.arguments if a.role == "out"]
    sizes = {"one": CACHED, "cached": CACHED} | ({"many": many} if many else {})
    runs, results = {}, []
    for shape, count in sizes.items():
        kept = _arrays(name, shape, count)
        function = loaded.repeat_one if shape == "one" else loaded.repeat_batch
        function.argtypes = (ctypes.c_size_t, ctypes.c_size_t, ctypes.c_void_p)

        repeat = _repeated(function, count, kept)
        runs[shape] = _timed(repeat, count)
        if shape == "cached":
            repeat(1)
            results = [array.copy() for array in kept[len(kept) - len(outputs) :]]
    return runs, results


def _symrot_text(name: str) -> str:
    found = emit(name)
    return found.source.replace(f'#include "{MATH_HEADER}"', math_header()).replace(
        f'#include "{name}.h"', found.header
    )


def _without_call(run: Callable[[int], Callable[[int], object]]) -> Callable[[], float]:
    """Return seconds per sample of a batch that is called from Python, by what it takes longer than a batch of one."""
    least, more = _timed(run(1), 1), _timed(run(CACHED), 1)
    calls, batches = [least()], [more()]

    def measure() -> float:
        calls.append(least())
        batches.append(more())
        return (min(batches) - min(calls)) / (CACHED - 1)

    return measure


def _heyoka(name: str, many: int) -> tuple[dict[str, Callable[[], float]], list[Floats]]:
    function = heyoka_function(name)
    size = sum(a.size for a in kernel_program(name).signature.arguments if a.role == "out")

    def run(count: int) -> Callable[[int], object]:
        given, found = np.concatenate(_samples(name, count)), np.empty((size, count))
        return lambda repeats: [function(given, outputs=found) for _ in range(repeats)]

    runs = {"cached": _without_call(run)} | ({"many": _timed(run(many), many)} if many else {})
    return runs, [function(np.concatenate(_samples(name, CACHED)))]


def contest(name: str, many: int = MANY) -> tuple[list[Contestant], list[str]]:
    """Return the contestants of a kernel, symrot first, their numbers compared, and the tools that are missing."""
    contestants, missing = [], []
    text = _symrot_text(name)
    runs, wanted = _in_c(name, text, True, many)
    contestants.append(Contestant("symrot", counted(emit(name).source, name), runs))
    reference = np.concatenate(wanted)

    def add(tool: str, operations: Counter[str], runs: dict[str, Callable[[], float]], found: list[Floats]) -> None:
        error = float(np.max(np.abs(np.concatenate(found) - reference)) / np.max(np.abs(reference)))
        if not error < 1e-11:
            raise AssertionError(f"{tool}: expected the numbers of symrot for {name}, differs by {error:.1e}")
        contestants.append(Contestant(tool, operations, runs))

    for tool, make in PEERS_IN_C.items():
        try:
            peer = make(name)
        except ImportError:
            missing.append(tool)
            continue
        if peer is not None:
            add(tool, counted(peer, name), *_in_c(name, "#include <math.h>\n" + peer, False, many))
    try:
        function, operations = casadi_function(name)
        add("CasADi C", operations, *_in_c(name, _casadi_text(name, function), False, many))
        machine, found = _casadi_machine(name, function)
        add("CasADi VM", operations, machine, found)
    except ImportError:
        missing.append("CasADi")
    try:
        add("heyoka", Counter(), *_heyoka(name, many))
    except ImportError:
        missing.append("heyoka")
    return contestants, missing


def _casadi_machine(name: str, function: Any) -> tuple[dict[str, Callable[[], float]], list[Floats]]:
    """Return CasADi's own evaluation of a batch, by its map over samples."""
    import casadi

    def run(count: int) -> Callable[[int], object]:
        mapped, given = function.map(count), casadi.DM(np.concatenate(_samples(name, count)))
        return lambda repeats: [mapped(given) for _ in range(repeats)]

    found = np.array(function.map(CACHED)(casadi.DM(np.concatenate(_samples(name, CACHED)))))
    return {"cached": _timed(run(CACHED), CACHED)}, [found]


def _casadi_text(name: str, function: Any) -> str:
    """Return CasADi's own C and a function of the kernel's arguments around it."""
    import casadi

    generator = casadi.CodeGenerator("peer", {"with_header": False})
    generator.add(function)
    signature = kernel_program(name).signature
    arguments, lines, place = [], [], 0
    for a in signature.arguments:
        const = "const " if a.role == "in" else ""
        arguments.append(f"double {a.name}" if a.is_scalar else f"{const}double {a.name}[{a.size}]")
    inputs = [a for a in signature.arguments if a.role == "in"]
    values = ", ".join(a.name if a.is_scalar else f"{a.name}[{i}]" for a in inputs for i in range(a.size))
    size = sum(a.size for a in signature.arguments if a.role == "out")
    lines += [f"static inline void {name}({', '.join(arguments)})", "{", f"    const double x[] = {{{values}}};",
              f"    double y[{size}];", "    const double *arg[1] = {x};", "    double *res[1] = {y};",
              "    peer(arg, res, 0, 0, 0);"]  # fmt: skip
    for a in signature.arguments:
        if a.role == "out":
            lines += [f"    {a.name}[{i}] = y[{place + i}];" for i in range(a.size)]
            place += a.size
    return str(generator.dump()) + "\n".join([*lines, "}"]) + "\n"


def measure(contestants: Sequence[Contestant], rounds: int) -> None:
    """Let all contestants take their turns."""
    for _ in range(rounds):
        for contestant in contestants:
            for shape, run in contestant.runs.items():
                contestant.seconds[shape].append(run())


def _line(contestant: Contestant) -> str:
    counts = contestant.operations
    said = ", ".join(f"{counts[kind]} {kind}" for kind in ("mul", "add", "div", "sin", "cos") if counts[kind]) or "-"
    times = (contestant.nanoseconds(shape) for shape in SHAPES)
    return f"  {contestant.name:10} {said:38}" + "".join(f"{time:10.2f}" if time else f"{'-':>10}" for time in times)


def _verdict(contestants: Sequence[Contestant]) -> str:
    """Return how symrot stands to the best of the others: flops, and the time of each shape."""
    own, others = contestants[0], contestants[1:]
    flops = [sum(c.operations.values()) for c in others if c.operations]
    parts = [f"operations {sum(own.operations.values())} to {min(flops)}"] if flops else []
    for shape in SHAPES:
        times = [time for c in others if (time := c.nanoseconds(shape))]
        mine = own.nanoseconds(shape)
        if times and mine:
            parts.append(f"{shape} {mine / min(times):.2f}")
    return "  symrot to the best of the others: " + ", ".join(parts)


def main(arguments: list[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m symrot.bench.kernels", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--many", type=int, default=MANY, help="samples of the large batch; 0 leaves it out")
    parser.add_argument("--kernels", nargs="*", help="kernels to compare, in the place of those of the table")
    options = parser.parse_args(arguments)
    rates = [f"euler_{sequence}_body_rates" for sequence in (*PROPER, *TAIT_BRYAN)]
    names = options.kernels or ["quaternion_dcm", *rates, "rigid_body_tensor", "heavy_top"]
    print(f"ns per sample: one at a time, {CACHED} in a batch, {options.many} in a batch; {' '.join(FLAGS[1:6])}")
    absent: set[str] = set()
    for name in names:
        contestants, missing = contest(name, options.many)
        absent |= set(missing)
        measure(contestants, options.rounds)
        print(f"{name}{'':{max(1, 51 - len(name))}}" + "".join(f"{shape:>10}" for shape in SHAPES))
        print("\n".join(map(_line, contestants)))
        print(_verdict(contestants), flush=True)
    print(f"not installed, left out: {', '.join(sorted(absent))}" if absent else "every tool took part")


if __name__ == "__main__":
    main()
