"""The Taylor stepper keeps its promises: coefficients, accuracy, sampling, direction, scales, limits."""

import math
import shutil
import subprocess
import tomllib
from fractions import Fraction
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from symrot.bench import taylor as bench
from symrot.build import cache as library
from symrot.codegen.taylor.coefficients import coefficients
from symrot.codegen.taylor.invariant_source import invariant_definitions
from symrot.codegen.taylor.recurrences import recurrences
from symrot.codegen.taylor.source import taylor_definitions
from symrot.ensemble.ensemble import propagate_ensemble
from symrot.errors import CompilerError, InputError, PropagationError
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import FUNCTIONS, parse
from symrot.planning.plan import make_plan
from symrot.planning.scene_kernel import bind
from symrot.propagation.compiled_models import error_blocks, scene_kernel
from symrot.propagation.propagate import propagator
from symrot.propagation.steppers import dop853, taylor
from symrot.propagation.steppers.stepping import Integration
from symrot.scene.scene import Scene, load_scene
from tests.codegen.test_recurrences import FUNCTION_SYSTEMS, START, SYSTEMS, program
from tests.reference.tops import MOTIONS, TIMES, error, parameters, state
from tests.reference.tops import taylor as reference

MATH = {name: getattr(math, name) for name in FUNCTIONS if name != "abs"}


def rigid_body_program():
    """Return the rates of a heavy body about a fixed point: moments a, b, c; weight times centre of mass; gravity along
    -z.
    """
    names = [f"w{i}" for i in (1, 2, 3)] + [f"q{i}" for i in range(4)]
    rates = [
        "((b - c)*w2*w3 + m2*g3 - m3*g2)/a", "((c - a)*w3*w1 + m3*g1 - m1*g3)/b", "((a - b)*w1*w2 + m1*g2 - m2*g1)/c",
        "-(q1*w1 + q2*w2 + q3*w3)/2", "(q0*w1 + q2*w3 - q3*w2)/2", "(q0*w2 + q3*w1 - q1*w3)/2", "(q0*w3 + q1*w2 - q2*w1)/2",
    ]  # fmt: skip
    gravity = {
        "n": "q0*q0 + q1*q1 + q2*q2 + q3*q3", "g1": "-2*(q1*q3 - q0*q2)/n", "g2": "-2*(q2*q3 + q0*q1)/n",
        "g3": "-(q0*q0 - q1*q1 - q2*q2 + q3*q3)/n",
    }  # fmt: skip

    def components(list_of_names):
        return tuple((name, "", "") for name in list_of_names)

    arguments = (
        Argument("t", "in", components(["t"]), True), Argument("y", "in", components(names)),
        Argument("p", "in", components(["a", "b", "c", "m1", "m2", "m3"])),
        Argument("dy", "out", components([f"d{name}" for name in names])),
    )  # fmt: skip
    return Program(
        Signature("body", arguments),
        tuple((name, parse(formula)) for name, formula in gravity.items()),
        tuple((f"d{name}", parse(rate)) for name, rate in zip(names, rates, strict=True)),
    )


@cache
def body():
    return library.build(taylor.translation_unit(rigid_body_program()), "body")


def small(rates, scale=1.0, flags=(), order=None):
    """Return a library for a few states in one block, with one parameter k."""
    source = taylor.translation_unit(program(rates), (0, len(rates)), (scale,), order)
    return library.build(source, "small", (*library.FLAGS, *flags))


# ------------------------------------------------------------------------------------------------ coefficients


@pytest.mark.usefixtures("quick_compiler")
@pytest.mark.parametrize(
    "flags", [(), ("-DSYMROT_PAIRS",), ("-DSYMROT_PLAIN",)], ids=["vectors", "vectors of two", "plain C"]
)
def test_compiled_coefficients_are_those_of_the_recurrences(flags):
    """All systems and functions, eight states to a library, so that SIMD lanes and groups of all kinds occur."""
    formulas = [f for rates in FUNCTION_SYSTEMS.values() for f in rates]
    groups = [formulas[i : i + 7] for i in range(0, len(formulas), 7)]
    for group in groups[:: 3 if flags else 1]:
        others = [f"s{i}" for i in range(len(group) - 2)]
        rates = dict(zip(["x", "y", *others], group, strict=True))
        compare(rates, flags)


@pytest.mark.thinned(3)
@pytest.mark.usefixtures("quick_compiler")
@pytest.mark.parametrize("name", SYSTEMS)
def test_compiled_polynomial_systems(name):
    compare(SYSTEMS[name])


def compare(rates, flags=(), order=20):
    start = {name: float(START.get(name, Fraction(1, 2))) for name in (*rates, "k", "t")}
    expected = np.array(coefficients(recurrences(program(rates)), order, start, MATH, float)).T
    stepper = taylor._stepper(small(rates, flags=flags, order=order))
    found = stepper.jet(start["t"], [start[name] for name in rates], [start["k"]])
    growth = 4.0 ** np.arange(order + 1)[:, None]  # rounding errors grow with the order as the terms do
    assert (abs(found - expected) <= 1e-15 * growth * abs(expected).max() + 1e-12 * abs(expected)).all()
    unit = stepper.jet(start["t"], [start[name] for name in rates], [start["k"]], 0.5)
    assert (unit == found * 0.5 ** np.arange(order + 1)[:, None]).all() or flags  # a power of two costs no bit


@pytest.mark.thinned(2)
@pytest.mark.usefixtures("quick_compiler")
@pytest.mark.parametrize("order", [4, 6, 10, 16, 22])
def test_any_even_order(order):
    compare(SYSTEMS["free body"], order=order)
    path = small({"x": "-y", "y": "x"}, order=order)
    states, _ = taylor.integration(path, [0.0], [1.0, 0.0], 0.0, 1e-8).sample([3.0])
    assert abs(states[0] - (math.cos(3), math.sin(3))).max() < 1e-6


@pytest.mark.usefixtures("quick_compiler")
@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    "name", ["heavy_top_loops", "gravity_gradient_satellite", "damped_disk", "gyrostat", "t_handle"]
)
def test_jets_of_shipped_scenes(name):
    plan = make_plan(load_scene(name))
    kernel = scene_kernel(plan)
    system = recurrences(kernel.rates)
    p = bind(kernel.rate_parameters, plan.constants)
    values = {
        **dict(zip(system.states, plan.initial_state, strict=True)),
        **dict(zip(system.parameters, p, strict=True)),
        "t": 0.25,
    }
    expected = np.array(coefficients(system, 20, values, MATH, float)).T
    found = taylor._stepper(scene_library(name)).jet(0.25, plan.initial_state, p)
    assert (abs(found - expected) <= 1e-11 * abs(expected).max(axis=1, keepdims=True) + 1e-300).all()


@cache
def scene_library(name):
    plan = make_plan(load_scene(name))
    return library.build(taylor.translation_unit(scene_kernel(plan).rates, *error_blocks(plan)), "scene")


def test_names_of_parameters_do_not_meet_names_in_c():
    """Parameters a, b, c, m1 and states w1 do not collide with c, x, n and m of the emitted text."""
    states, _ = taylor.integration(body(), parameters("asymmetric"), MOTIONS["asymmetric"][2], 0.0, 1e-12).sample([1.0])
    assert np.isfinite(states).all()


def test_the_same_program_gives_the_same_text():
    assert taylor.translation_unit(rigid_body_program()) == taylor.translation_unit(rigid_body_program())


def test_code_does_not_grow_with_the_order():
    sizes = [len(taylor_definitions(rigid_body_program(), (0, 3, 7), (0.0, 1.0), order)) for order in (12, 28)]
    assert sizes[1] - sizes[0] < 300


# ------------------------------------------------------------------------------------------------ accuracy


@pytest.mark.thinned(4)
@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
def test_the_error_of_the_trajectory_stays_near_the_tolerance(name, tolerance):
    """Here it is at most 6 times the tolerance; the bound 10 leaves room for the rounding of other processors."""
    states, _ = taylor.integration(body(), parameters(name), MOTIONS[name][2], 0.0, tolerance).sample(TIMES)
    assert error(states, reference(name)) < 10 * tolerance


@pytest.mark.usefixtures("quick_compiler")
def test_orders_for_tolerances_keep_the_promise():
    """Loose tolerances take lower orders, and their errors are within the promise too."""
    assert [taylor.order_for(e) for e in (1e-2, 1e-3, 1e-4, 1e-6, 1e-7, 1e-15)] == [14, 14, 16, 16, 20, 20]
    for tolerance in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6):
        source = taylor.translation_unit(rigid_body_program(), order=taylor.order_for(tolerance))
        path = library.build(source, "body")
        for name in MOTIONS:
            states, _ = taylor.integration(path, parameters(name), MOTIONS[name][2], 0.0, tolerance).sample(TIMES)
            assert error(states, reference(name)) < 10 * tolerance


@pytest.mark.thinned(2)
@pytest.mark.parametrize("name", bench.MOTIONS)
def test_long_motions_keep_the_promise(name):
    """184 revolutions of a free body, 200 s of heavy tops; rounding alone takes the last bits."""
    problem, exact = bench.SteppedProblem(name, 1.0), bench.reference(name)
    for tolerance in (1e-4, 1e-7, 1e-10, 1e-12):
        states, _ = taylor.integration(problem.taylor_library(), problem.taylor_p, problem.y0, 0.0, tolerance).sample(
            [problem.stop]
        )
        assert problem.largest_error(states[0], exact) < 5 * tolerance
    states, _ = taylor.integration(problem.taylor_library(), problem.taylor_p, problem.y0, 0.0, 1e-15).sample(
        [problem.stop]
    )
    assert problem.largest_error(states[0], exact) < 2e-12


@pytest.mark.usefixtures("quick_compiler")
def test_the_kept_references_are_those_computed():
    """40-digit series over a short span both ways agree with the stepper near round-off, and not with a wrong state."""
    exact = bench.reference("heavy symmetric", 0.01)
    problem = bench.SteppedProblem("heavy symmetric", 0.01)
    states, _ = taylor.integration(problem.taylor_library(), problem.taylor_p, problem.y0, 0.0, 1e-15).sample(
        [problem.stop]
    )
    assert problem.largest_error(states[0], exact) < 3e-15
    assert problem.largest_error(states[0] + 1e-9, exact) > 1e-10


REFERENCE = tomllib.loads((Path(__file__).parents[1] / "reference" / "trajectories.toml").read_text())


@pytest.mark.usefixtures("quick_compiler")
@pytest.mark.parametrize("name", [name for name in REFERENCE if name != "t_handle"])
@pytest.mark.parametrize("tolerance", [1e-4, 1e-8, 1e-12])
def test_shipped_scenes_keep_the_promise(name, tolerance):
    plan = make_plan(load_scene(name))
    p = bind(scene_kernel(plan).rate_parameters, plan.constants)
    t = [float(Fraction(row["t"])) for row in REFERENCE[name]]
    states, _ = taylor.integration(
        scene_library(name), p, plan.initial_state, float(plan.scene.span.start), tolerance
    ).sample(t)
    for found, row in zip(states, REFERENCE[name], strict=True):
        rates = {n: v for n, v in zip(plan.states, found, strict=True) if n.startswith("omega")}
        exact = {f"omega_{i + 1}": float(v) for i, v in enumerate(row["omega"])}
        size = max(abs(v) for v in exact.values())
        assert all(abs(value - exact[n]) < 20 * tolerance * size for n, value in rates.items())


def test_a_symmetric_body_follows_its_closed_form():
    a, c, w1, w3 = 2.0, 3.0, 0.4, 1.1
    t = np.linspace(-30, 50, 17)
    states, _ = taylor.integration(body(), (a, a, c, 0, 0, 0), state((w1, 0, w3)), 0.0, 1e-13).sample(t)
    rate = (c - a) / a * w3
    assert abs(states[:, 0] - w1 * np.cos(rate * t)).max() < 1e-13
    assert abs(states[:, 1] - w1 * np.sin(rate * t)).max() < 1e-13


@pytest.mark.parametrize("speed", [1.0, 1e3, 1e6])
def test_rates_do_not_hide_the_attitude(speed):
    """S17: one norm for omega and attitude would let the attitude err by the speed times the tolerance."""
    start, p = state((1e-3, 1e-3, speed)), (1.0, 1.5, 2.0, 0.0, 0.0, 0.0)
    loose, _ = taylor.integration(body(), p, start, 0.0, 1e-9).sample([1000 / speed])
    tight, _ = taylor.integration(body(), p, start, 0.0, 1e-14).sample([1000 / speed])
    assert abs(loose - tight)[0, 3:].max() < 1e-8


def test_energy_is_kept_over_many_revolutions():
    """A free body for 10 000 s, about 1800 revolutions, at the tightest tolerance."""
    moments, start = np.array([1.0, 2.0, 4.0]), state((0.3, 1.0, 0.5))
    states, _ = taylor.integration(body(), (*moments, 0, 0, 0), start, 0.0, 1e-15).sample([1e4])
    energy, before = (moments * states[0, :3] ** 2).sum(), (moments * start[:3] ** 2).sum()
    assert abs(energy / before - 1) < 1e-13
    assert abs(np.linalg.norm(states[0, 3:]) - 1) < 1e-13


def test_there_and_back_again():
    """S32: a heavy top goes forward 100 s and back, and returns to its start up to rounding."""
    p, start = parameters("asymmetric top"), MOTIONS["asymmetric top"][2]
    there, _ = taylor.integration(body(), p, start, 0.0, 1e-15).sample([100.0])
    back, _ = taylor.integration(body(), p, there[0], 100.0, 1e-15).sample([0.0])
    assert abs(back[0] - start).max() < 1e-11


# ------------------------------------------------------------------------------------------------ scales


@pytest.mark.parametrize("power", [-300, -60, 60, 300])
def test_no_bit_depends_on_the_unit_of_time(power):
    """S15: omega times 2^k and t over 2^k give omega times 2^k and the same attitude, bit for bit."""
    p, start, t = parameters("asymmetric"), MOTIONS["asymmetric"][2], np.array([3.0, 7.0])
    plain, _ = taylor.integration(body(), p, start, 0.0, 1e-12).sample(t)
    factor = np.array([2.0**power] * 3 + [1.0] * 4)
    scaled, _ = taylor.integration(body(), p, start * factor, 0.0, 1e-12).sample(t / 2.0**power)
    assert (scaled == plain * factor).all()


def test_a_body_at_rest_stays_and_one_that_is_started_starts():
    at_rest, stats = taylor.integration(body(), (1, 2, 3, 0, 0, 0), state((0, 0, 0)), 0.0, 1e-9).sample([5.0])
    assert (at_rest[0] == state((0, 0, 0))).all() and stats.accepted <= 3
    hanging, _ = taylor.integration(body(), (1, 1, 1, 1, 0, 0), state((0, 0, 0)), 0.0, 1e-12).sample([1.0])
    oracle = dop853_states(hanging_program(), [1.0])
    assert abs(hanging - oracle).max() < 1e-10


def hanging_program():
    return (1, 1, 1, 1, 0, 0), state((0, 0, 0))


def dop853_states(motion, times):
    from tests.propagation.test_dop853 import body as dop853_body

    p, start = motion
    return dop853.integration(dop853_body(), p, start, 0.0, 1e-13).sample(times)[0]


@pytest.mark.usefixtures("quick_compiler")
def test_a_polynomial_motion_takes_few_steps():
    path = small({"x": "3*t**2", "y": "x"}, scale=0.0)
    states, stats = taylor.integration(path, [0.0], [0.0, 1.0], 0.0, 1e-12).sample([1000.0])
    assert states[0] == pytest.approx([1e9, 1 + 1e12 / 4], rel=1e-14) and stats.accepted < 10


# ------------------------------------------------------------------------------------------------ sampling


def spin(times, tolerance=1e-13, **more):
    return taylor.integration(small({"x": "-k*y", "y": "k*x"}), [1.0], [1.0, 0.0], 0.0, tolerance, **more).sample(times)


def test_samples_in_any_order_repeated_and_on_both_sides():
    t = np.random.default_rng(1).uniform(-20, 20, 500)
    t[::50] = 0.0
    t[7] = t[8]
    states, _ = spin(t)
    assert abs(states - np.stack([np.cos(t), np.sin(t)], axis=1)).max() < 3e-14
    assert (states[::50] == (1.0, 0.0)).all() and (states[7] == states[8]).all()


def test_dense_output_is_as_good_as_the_steps():
    """S39: many samples are no worse than the end point."""
    t = np.linspace(0, 20, 20001)
    name = "asymmetric top"
    states, _ = taylor.integration(body(), parameters(name), MOTIONS[name][2], 0.0, 1e-11).sample(t)
    assert error(states[:: 20000 // 8], reference(name)) < 1e-10
    fine, _ = taylor.integration(body(), parameters(name), MOTIONS[name][2], 0.0, 1e-14).sample(t)
    assert abs(states - fine).max() < 1e-10


def test_a_recording_agrees_with_samples():
    p, start = parameters("asymmetric"), MOTIONS["asymmetric"][2]
    solution = taylor.integration(body(), p, start, 0.0, 1e-12).record((-5.0, 20.0))
    t = np.linspace(-5, 20, 1001)
    states, _ = taylor.integration(body(), p, start, 0.0, 1e-12).sample(t)
    assert abs(solution(t) - states).max() < 1e-13
    assert (solution(0.0) == start).all() and solution.span == (-5.0, 20.0)
    with pytest.raises(
        InputError, match=r"expected times from -5\.0 to 20\.0 s, where the motion is known, got 21\.0 s"
    ):
        solution(21.0)


def test_a_run_in_pieces_is_the_same_run(monkeypatch):
    t = np.linspace(0, 300, 50)
    whole, _ = spin(t)
    monkeypatch.setattr(taylor._Stepper, "steps_per_call", 1)
    pieces, _ = spin(t)
    assert (whole == pieces).all()


def test_no_times_and_the_initial_time():
    assert spin([])[0].shape == (0, 2)
    assert (spin([0.0, 0.0])[0] == (1.0, 0.0)).all()


def test_the_longest_step_is_kept():
    assert spin([10.0], max_step=0.01)[1].accepted >= 1000


# ------------------------------------------------------------------------------------------------ limits


@pytest.mark.usefixtures("quick_compiler")
@pytest.mark.parametrize(
    "rates, start, words",
    [
        ({"x": "x*x"}, [1.0], r"beyond t = (0.99|1\.0)\d* s on the way to 3.0 s: the step shrank"),
        ({"x": "sqrt(x)"}, [-1.0], r"beyond t = 0.0 s .*derivatives are not finite"),
        ({"x": "1/x"}, [0.0], r"beyond t = 0.0 s .*derivatives are not finite"),
    ],
)  # fmt: skip
def test_a_motion_that_ends_is_reported(rates, start, words):
    with pytest.raises(PropagationError, match=words):
        taylor.integration(small(rates), [0.0], start, 0.0, 1e-9).sample([3.0])


def test_too_many_steps_are_refused():
    with pytest.raises(PropagationError, match="7 steps were not enough"):
        spin([1000.0], max_steps=7)


@pytest.mark.parametrize(
    "change, words",
    [
        ({"tolerance": 0.0}, "between 0 and 1, got 0.0"),
        ({"tolerance": math.nan}, "between 0 and 1"),
        ({"times": [[1.0]]}, r"times: expected a sequence of sample times in s, got an array of shape \(1, 1\)"),
        ({"times": [1.0, math.inf]}, "times: expected finite sample times in s, got inf"),
        ({"times": [math.nan, 1.0]}, "times: expected finite sample times in s, got nan"),
        ({"y0": [1.0]}, r"states: expected an array of shape \(2,\) for this kernel, got shape \(1,\)"),
        ({"y0": [1.0, math.nan]}, "states: expected finite numbers"),
        ({"p": []}, r"parameters: expected an array of shape \(1,\) for this kernel"),
        ({"t0": math.inf}, "t0: expected a finite initial time"),
        ({"max_step": 0.0}, "max_step: expected a positive number"),
    ],
)  # fmt: skip
def test_bad_input_is_refused_in_one_sentence(change, words):
    good = {"p": [1.0], "y0": [1.0, 0.0], "t0": 0.0, "times": [1.0], "tolerance": 1e-6}
    with pytest.raises(InputError, match=words):
        arguments = good | change
        times = arguments.pop("times")
        taylor.integration(small({"x": "-k*y", "y": "k*x"}), **arguments).sample(times)


def test_what_is_not_smooth_is_refused():
    with pytest.raises(InputError, match="got abs of a quantity that changes; use method dop853"):
        taylor.translation_unit(program({"x": "-abs(x)"}), (0, 1), (1.0,))
    assert "abs" in taylor.refusal(program({"x": "-abs(x)"}))
    assert taylor.refusal(rigid_body_program()) == ""


@pytest.mark.parametrize("order", [2, 7, -4])
def test_odd_orders_are_refused(order):
    with pytest.raises(InputError, match=f"even number, at least 4, got {order}"):
        small({"x": "x"}, order=order)


@pytest.mark.parametrize("blocks, scales", [((0, 1), (1.0,)), ((0, 1, 1, 2), (1, 1, 1)), ((0, 2), (1, 1))])
def test_blocks_that_do_not_fit_are_refused(blocks, scales):
    with pytest.raises(InputError, match=r"expected block edges that increase from 0 to 2 \(the number of states\)"):
        taylor.translation_unit(program({"x": "y", "y": "x"}), blocks, scales)


def test_flags_that_kill_the_carry_are_noticed():
    """S28: -ffast-math stops the build; the single flags that it stands for are noticed when the library loads."""
    with pytest.raises(CompilerError, match="fast-math"):
        small({"x": "-x"}, flags=("-ffast-math",))
    path = small({"x": "-x"}, flags=("-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math"))
    with pytest.raises(CompilerError, match="ignores rounding errors"):
        taylor.integration(path, [0.0], [1.0], 0.0, 1e-6).sample([1.0])


def test_the_carry_is_alive():
    """S28: after many steps the carry holds the rounding errors."""
    task = Integration(taylor._stepper, body(), parameters("asymmetric"), MOTIONS["asymmetric"][2], 0.0, 1e-12)
    run = next(task.runs(500.0))
    task.advance(run, None, 0, None, None, 0)
    sizes = [abs(carry) for carry in run.carry]
    assert max(sizes) <= 2.0**-52 and sum(map(bool, sizes)) > len(sizes) / 2  # by chance a sum is exact


def test_a_library_of_another_stepper_is_refused(tmp_path):
    with pytest.raises(CompilerError, match="cannot be loaded"):
        taylor.integration(tmp_path / "none.so", [], [], 0.0, 1e-6).sample([1.0])


@pytest.mark.thinned(3)
@pytest.mark.skipif(shutil.which("g++") is None, reason="needs g++")
@pytest.mark.parametrize("plain", [[], ["-DSYMROT_PAIRS"], ["-DSYMROT_PLAIN"]])
def test_the_text_is_cplusplus_too_and_draws_no_warning(plain, tmp_path):
    source = taylor.translation_unit(rigid_body_program())
    for compiler, language, standard in (("gcc", "c", "-std=c99"), ("g++", "c++", "-std=c++14")):
        command = [
            compiler,
            "-x",
            language,
            standard,
            "-O1",
            "-march=native",
            "-Wall",
            "-Wextra",
            "-Werror",
            *plain,
            "-c",
            "-",
            "-o",
        ]
        subprocess.run([*command, str(tmp_path / "x.o")], input=source.encode(), check=True)


@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
def test_a_text_without_invariants_needs_no_optimizer_to_link(tmp_path):
    """A call of a missing function is an error in C, even if an optimizer drops the code around it."""
    system = program({"x": "-k*x + t"})
    source = taylor.translation_unit(system, (0, 1), (1.0,), invariants=invariant_definitions(system, [], ["x"], ["k"]))
    command = ["gcc", "-x", "c", "-std=c99", "-O0", "-march=native", "-Werror=implicit-function-declaration", "-shared",
               "-fPIC", "-Wl,-z,defs", "-", "-lm", "-o", str(tmp_path / "x.so")]  # fmt: skip
    subprocess.run(command, input=source.encode(), check=True)


# ------------------------------------------------------------------------------------------------ benchmark


@pytest.mark.campaign
def test_the_benchmark_runs_and_ranks():
    runs = bench.measure("heavy symmetric", rounds=1, scale=0.02)
    assert {"taylor", "dop853"} <= {run.name for run in runs}
    best = bench.best_of(runs, 1e-9, ["taylor"])
    assert best is not None and best.error <= 1e-9
    assert bench.best_of(runs, 1e-30, ["taylor"]) is None


@pytest.mark.thinned(10)
@pytest.mark.usefixtures("quick_compiler")
@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("power", range(1, 7))
def test_series_with_gaps_are_followed(power, tolerance):
    """A sphere at rest under t^k: its angle is t^(k+2)/((k+1)(k+2)), and k + 1 coefficients of its attitude are zero."""
    made = load_scene_of([f"t**{power}", "0", "0"], 4.0)
    motion = propagator(made, "taylor", tolerance)(np.linspace(0, 4, 33))
    half = motion.t ** (power + 2) / (power + 1) / (power + 2) / 2
    expected = np.stack([np.cos(half), np.sin(half)], axis=1)
    assert abs(motion.quaternion[:, :2] - expected).max() < 20 * tolerance + 1e-13 * half[-1]


def test_powers_beyond_the_order_are_followed():
    """omega_1 = t^7/7 drives omega_2 = t^43/(43 7^6), a power beyond the order of the series."""
    made = load_scene_of(["t**6", "omega_1**6", "0"], 2.0)
    expected = 2.0**43 / 43 / 7**6
    assert propagator(made, "taylor", 1e-9)([2.0]).omega[0, 1] == pytest.approx(expected, rel=1e-7)
    many = propagate_ensemble(made, omega=np.zeros((3, 3)), t=[2.0], tolerance=1e-9)
    assert many.omega[:, 0, 1] == pytest.approx(expected, rel=1e-7)


def load_scene_of(torque, stop):
    return Scene.from_dict({
        "schema": 1, "body": {"principal": [1, 1, 1]}, "initial": {"omega": [0, 0, 0]}, "span": {"t": [0, stop]},
        "torque": [{"kind": "expression", "torque": torque}], "output": {"quantities": ["omega", "quaternion"]},
    })  # fmt: skip
