"""Stress tests S40 and S41: speed compared with heyoka, and the instruction sets of this processor."""

import math
from pathlib import Path
from time import perf_counter

import numpy as np

from symrot.bench import dense
from symrot.bench import taylor as race
from symrot.build import cache as library
from symrot.planning.plan import make_plan
from symrot.planning.scene_kernel import bind
from symrot.propagation.compiled_models import library_source, scene_kernel
from symrot.propagation.steppers import dop853
from tests.reference.figures import Figure, largest
from tests.reference.stress_stepping import Stepped, asymmetric_top


def s40(long):
    """Compare the speed with heyoka's in one interleaved run; needs heyoka."""
    import heyoka  # noqa: F401 - not run without it

    from symrot.bench import ensemble

    name, found = "heavy asymmetric", []
    runs = race.measure(name, rounds=9)
    ratios = []
    for decade in (1e-6, 1e-9, 1e-12):
        ours, theirs = (race.best_of(runs, decade, [each]) for each in ("taylor", "heyoka"))
        ratios.append(theirs.least / ours.least)
    found.append(Figure("taylor", "one trajectory, times heyoka's speed, 1e-6 to 1e-12", 2, min(ratios), at_least=True))
    problem = race.SteppedProblem(name, 1.0)
    runs = ensemble.measure(ensemble.prepare(8, problem.stop, problem), 9)
    peers = sorted({run.name for run in runs} - {"lanes"})
    ratios = []
    for decade in (1e-6, 1e-9, 1e-12):
        ours, theirs = race.best_of(runs, decade, ["lanes"]), race.best_of(runs, decade, peers)
        ratios.append(theirs.least / ours.least)
    found.append(Figure("lanes", "batch of 8, times heyoka's speed", 1.7, min(ratios), at_least=True))
    found += _dense(name)
    plain, slp = (Stepped(asymmetric_top(), flags=flags) for flags in (library.FLAGS, (*library.FLAGS, "-O3")))
    best = _raced([lambda s=s: s.at(200.0, 1e-12) for s in (plain, slp)])
    found.append(
        Figure("taylor", "time with -O3 over that of our flags", 1.3, max(best[1] / best[0], best[0] / best[1]))
    )
    return found


def _dense(name):
    """Compare 20 000 samples at equal error, steps included; then at equal tolerances, with steps and samples apart.

    At equal tolerances the error of symrot is a hundred times smaller, so this comparison has no bar.
    """
    samples, found = 20_000, []
    many, two = ({(one.name, one.tolerance): one for one in dense.measure(name, count, 15)} for count in (samples, 2))
    peers = [(way, tolerance) for way, tolerance in many if way == "heyoka grid"]
    pairs = []
    for peer in peers:
        ours = [key for key, one in many.items() if key[0] == "taylor" and one.error <= many[peer].error]
        if ours:
            pairs.append((peer, min(ours, key=lambda key: many[key].least)))
    ratios = [many[peer].least / many[own].least for peer, own in pairs]
    title = f"{samples} samples at equal error, times heyoka's speed"
    found.append(Figure("taylor", title, 5, min(ratios), at_least=True))
    peer, own = pairs[ratios.index(min(ratios))]
    steps = two[peer].least / two[own].least
    beyond = [(many[key].least - two[key].least) / samples * 1e9 for key in (own, peer)]
    same = ("taylor", 1e-12), ("heyoka grid", 1e-12)
    why = "" if found[0].good else "why: "
    shown = [
        (f"{why}the steps alone, {two[own].least / many[own].least:.0%} of our time", steps),
        (f"{why}ns a sample beyond the steps", beyond[0]),
        (f"{why}ns a sample beyond the steps, heyoka", beyond[1]),
        ("at equal tolerances of 1e-12", many[same[1]].least / many[same[0]].least),
        ("heyoka's error over ours there", many[same[1]].error / many[same[0]].error),
    ]
    return found + [Figure("taylor", what, 0, value, judged=False) for what, value in shown]


def _raced(runs, rounds=15):
    """Return the least time of each run, s, from interleaved rounds."""
    best = [math.inf] * len(runs)
    for _ in range(rounds):
        for i, run in enumerate(runs):
            began = perf_counter()
            run()
            best[i] = min(best[i], perf_counter() - began)
    return best


def _instruction_sets():
    """Return this processor's instruction sets: name -> flags that restrict the compiler to it."""
    try:
        has = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        has = ""
    sets = {"SSE2": ("-march=x86-64",), "plain C": ("-march=x86-64", "-DSYMROT_PLAIN")}
    if " avx2 " in has:
        sets = {"AVX2": ("-march=haswell",), **sets}
    if " avx512vl " in has:
        sets = {"AVX-512": ("-march=skylake-avx512",), **sets}
    return sets


def s41(long):
    scene = asymmetric_top()
    plan = make_plan(scene)
    kernel = scene_kernel(plan)
    sets, ends, runs = _instruction_sets(), {}, []
    hairer_source = library_source(plan, kernel)
    p = bind(kernel.rate_parameters, plan.constants)
    for name, flags in sets.items():
        flags = tuple(flag for flag in library.FLAGS if not flag.startswith("-march")) + flags
        stepped = Stepped(scene, flags=flags)
        hairer = library.build(hairer_source, "motion", flags)
        own, steps = stepped.at(20.0, 1e-13)
        other, tries = dop853.integration(hairer, p, stepped.start, 0.0, 1e-10).sample([5.0])
        ends[name] = (own[0], steps.accepted, other[0], tries.accepted)
        runs.append(lambda stepped=stepped: stepped.at(200.0, 1e-12))
    first, *others = ends
    found = []
    for name in others:
        ulps = [largest(ends[name][k] / np.maximum(1, np.abs(ends[first][k])), ends[first][k] / np.maximum(
            1, np.abs(ends[first][k]))) / 2.0**-52 / ends[first][k + 1] for k in (0, 2)]  # fmt: skip
        found += [Figure("taylor", f"{name} against {first}, ulp per step", 4, ulps[0]),
                  Figure("dop853", f"{name} against {first}, ulp per step", 4, ulps[1])]  # fmt: skip
    if long:
        best = dict(zip(sets, _raced(runs), strict=True))
        found += [Figure("taylor", f"time with {name} over {first}", 1.5, best[name] / best[first], judged=name == "AVX2")
                  for name in others]  # fmt: skip
    return found
