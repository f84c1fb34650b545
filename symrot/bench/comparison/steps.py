"""Comparison of one emitted time step with the same step made by other tools: operations, and nanoseconds per step.

    python -m symrot.bench.comparison.steps [--rounds 31] [--scenes NAME ..] [--count]

Each tool gets the rates of the scene's states as formulas in which no subexpression has a name, and finds the common
subexpressions itself. The steps of all tools are timed alternately from the same states, and their results are
compared.
"""

import argparse
import ctypes
from collections import Counter
from collections.abc import Callable
from importlib import import_module
from random import Random
from time import perf_counter
from typing import Any

import numpy as np
import sympy
from sympy import Expr

from symrot.bench.by_hand.kernel_peers import casadi_counts, casadi_text, counted, products
from symrot.bench.kernels import FLAGS
from symrot.build import cache as build_cache
from symrot.codegen.lowering.formulas import to_node
from symrot.codegen.printing.c_function import c_function, c_name
from symrot.codegen.steps import step_signature, stepped
from symrot.errors import InputError
from symrot.formula.program import Program
from symrot.formula.tree import Node, children, with_children
from symrot.scene.scene import load_scene
from symrot.workshop.step_text import StepText, step_method

__all__ = ["main"]

SCENES = ("tumbling_prism", "heavy_top_loops", "gyrostat", "gravity_gradient_satellite")
STEPS = (("rk4", None), ("taylor", 4))
SAMPLES, REPEATS = 1000, 20
FUNCTIONS = ("sin", "cos", "tan", "sqrt", "exp", "log")


def _plain_rates(rates: Program) -> Program:
    """Return the rates with each output as one formula, without names for common subexpressions."""
    # The other tools look for common terms themselves.
    known: dict[str, Node] = {}

    def explicit(node: Node) -> Node:
        if node[0] == "symbol":
            return known.get(node[1], node)
        return with_children(node, list(map(explicit, children(node))))

    for name, node in rates.temporaries:
        known[name] = explicit(node)
    return Program(rates.signature, (), tuple((name, explicit(node)) for name, node in rates.outputs))


def _inputs(step: StepText) -> list[str]:
    signature = step_signature(step.certified.rates, step.name)
    return [name for a in signature.arguments if a.role == "in" for name, *_ in a.components]


def _symforce(step: StepText) -> tuple[str, Counter[str]]:
    """Return the C text of one step, in which SymForce found the common terms, and the number of operations of each
    kind.
    """
    sf: Any = import_module("symforce.symbolic")
    values = {name: sf.Symbol(name) for name in _inputs(step)}
    functions = {name: getattr(sf, name) for name in FUNCTIONS}
    outputs = stepped(
        _plain_rates(step.certified.rates), step.method, values, values["dt"], functions,
        lambda number: sf.Rational(number.numerator, number.denominator),
    )  # fmt: skip
    common, results = sf.cse(outputs, symbols=(sf.Symbol(f"common{i}") for i in range(100000)))
    local = {name: sympy.Symbol(name, real=True) for name in _inputs(step)}

    def plain(value: object) -> Expr:
        return sympy.sympify(str(value), locals=local)

    signature = step_signature(step.certified.rates, step.name)
    names = [name for name, *_ in signature.argument("next").components]
    program = Program(
        signature,
        tuple((str(symbol), products(to_node(plain(value)))) for symbol, value in common),
        tuple((name, products(to_node(plain(value)))) for name, value in zip(names, results, strict=True)),
    )
    text = c_function(program)
    return text, counted(text, step.name)


def _casadi(step: StepText) -> tuple[str, Counter[str]]:
    """Return the C text of one step as CasADi generates it, and the number of operations of each kind in the text."""
    import casadi

    names = _inputs(step)
    x = casadi.SX.sym("x", len(names))
    values = {name: x[i] for i, name in enumerate(names)}
    functions = {name: getattr(casadi, name) for name in FUNCTIONS}
    outputs = stepped(_plain_rates(step.certified.rates), step.method, values, values["dt"], functions, float)
    function, operations = casadi_counts(x, casadi.vertcat(*outputs))
    return casadi_text(function, step_signature(step.certified.rates, step.name)), operations


PEERS: dict[str, Callable[[StepText], tuple[str, Counter[str]]]] = {"SymForce": _symforce, "CasADi": _casadi}


def _driver(step: StepText) -> str:
    """Return a C function that makes one step from each of n states, and repeats all this a given number of times."""
    signature = step_signature(step.certified.rates, step.name)
    size = signature.argument("next").size
    called = ["t", f"x + {size}*k", *(["p"] if any(a.name == "p" for a in signature.arguments) else []), "dt",
              f"next + {size}*k"]  # fmt: skip
    return f"""
#include <stddef.h>
void symrot_repeat(size_t repeats, size_t n, double t, const double *x, const double *p, double dt, double *next)
{{
    for (size_t r = 0; r < repeats; ++r)
        for (size_t k = 0; k < n; ++k) {{
            {c_name(step.name)}({", ".join(called)});
            __asm__ volatile("" ::: "memory"); /* one step at a time */
        }}
}}
"""


def _run(step: StepText, text: str) -> Callable[[], tuple[float, Any]]:
    """Compile ``text``, the C function of one time step as a tool generated it, and return a function that times it.

    The returned function makes steps from random states; it returns (seconds per step, states after the step).
    """
    loaded = ctypes.CDLL(
        str(build_cache.build(f"#include <math.h>\n{text}{_driver(step)}", f"bench_{step.name}", FLAGS))
    )
    function = loaded.symrot_repeat
    number, vector = ctypes.c_double, ctypes.c_void_p
    function.argtypes = (ctypes.c_size_t, ctypes.c_size_t, number, vector, vector, number, vector)
    count = step_signature(step.certified.rates, step.name).argument("next").size
    start = np.random.default_rng(5).uniform(-1, 1, (SAMPLES, count))
    parameters, after = np.array([*step.certified.values, 0.0]), np.empty_like(start)

    def measure() -> tuple[float, Any]:
        began = perf_counter()
        function(REPEATS, SAMPLES, 0.0, start.ctypes.data, parameters.ctypes.data, 1e-3, after.ctypes.data)
        return (perf_counter() - began) / (REPEATS * SAMPLES), after

    return measure


def _own_text(step: StepText) -> str:
    source, header = step.c()
    return source.replace(f'#include "{step.name}.h"', header)


def main(arguments: list[str] | None = None) -> None:
    """Print, for each scene and method, operations and times of one step by symrot and by the other tools."""
    parser = argparse.ArgumentParser(
        prog="python -m symrot.bench.comparison.steps", description=(__doc__ or "").split("\n")[0]
    )
    parser.add_argument("--rounds", type=int, default=31)
    parser.add_argument("--scenes", nargs="+", metavar="NAME", default=SCENES)
    parser.add_argument("--count", action="store_true", help="count operations only")
    options = parser.parse_args(arguments)
    try:
        for scene in options.scenes:
            load_scene(scene)
    except InputError as reason:
        parser.error(f"--scenes: {reason}")
    absent, over = set[str](), []
    for scene in options.scenes:
        for method, order in STEPS:
            step = StepText(load_scene(scene), step_method(method, order))
            texts = {"symrot": (_own_text(step), counted(step.c()[0], step.name))}
            for tool, make in PEERS.items():
                try:
                    texts[tool] = make(step)
                except ImportError:
                    absent.add(tool)
            totals = {tool: operations.total() for tool, (_, operations) in texts.items()}
            times = (
                {} if options.count else _times(step, {tool: text for tool, (text, _) in texts.items()}, options.rounds)
            )
            cells = [
                f"{tool} {total}" + (f" ({times[tool] * 1e9:.1f} ns)" if times else "")
                for tool, total in totals.items()
            ]
            print(f"{step.name}: {', '.join(cells)}", flush=True)
            over += [f"{step.name}: {tool} needs fewer operations" for tool, count in totals.items()
                     if count < totals["symrot"]]  # fmt: skip
            over += [f"{step.name}: {times['symrot'] / times[tool]:.2f} times the time of {tool}" for tool in times
                     if times["symrot"] > 1.05 * times[tool]]  # fmt: skip
    print(f"not installed, left out: {', '.join(sorted(absent))}" if absent else "every tool took part")
    print(f"steps in which symrot needs more operations, or over 1.05 times the time: {'; '.join(over) or 'none'}")


def _times(step: StepText, texts: dict[str, str], rounds: int) -> dict[str, float]:
    """Return a map from each tool to its least time per step, s; raise AssertionError if the results of two tools
    differ.
    """
    runs = {tool: _run(step, text) for tool, text in texts.items()}
    results = {tool: np.array(run()[1]) for tool, run in runs.items()}
    for tool, result in results.items():
        error = float(np.max(np.abs(result - results["symrot"])))
        if not error < 1e-11 * float(np.max(np.abs(results["symrot"]))):
            raise AssertionError(
                f"{tool}: expected results equal to those of symrot for {step.name}, got a difference of {error:.1e}"
            )
    least: dict[str, float] = {}
    draw = Random(5)
    for _ in range(rounds):
        for tool in draw.sample(list(runs), len(runs)):
            least[tool] = min(least.get(tool, 1.0), runs[tool]()[0])
    return {tool: least[tool] for tool in texts}


if __name__ == "__main__":
    main()
