"""All stress tests of numerical stability: ``python -m tests.reference.stress [--quick] [--json] [S6 S7 ..]``.

Each row is one measured figure: the method, what was measured, the bar (its limit), the value, the verdict. Without
``--quick`` every test runs at its full length (a few minutes). The exit code is 1 if a bar is not met. The references
share nothing with the code they judge: elliptic integrals and Taylor series in 50 digits, closed forms, heyoka,
50-digit conversions.
"""

import argparse
import json
import sys
from time import perf_counter

from tests.reference import stress_conversions as conversions
from tests.reference import stress_exact as exact
from tests.reference import stress_found as found
from tests.reference import stress_order as order
from tests.reference import stress_speed as speed
from tests.reference import stress_stepping as stepping
from tests.reference.figures import Figure, Stress

STRESSES = (
    Stress("S1", "chirality", "I = (1,2,3), w = (.3,1,.5)", exact.s1),
    Stress("S2", "axis permutations", "6 orders, 8 signs, 3 rates", exact.s2, quick=False),
    Stress("S3", "long phase", "S1 and both other regimes, in periods", exact.s3),
    Stress("S4", "huge time", "60-digit reference", exact.s4),
    Stress("S5", "random bodies", "t to 1e6 periods", exact.s5),
    Stress("S6", "near separatrix", "w = (e,1,e), e = 1e-3 .. 1e-12", exact.s6),
    Stress("S7", "fat separatrix", "w = (1,1,(1+d)/sqrt 3), d to 1e-15", exact.s7),
    Stress("S8", "exact separatrix", "I = (3,4,6)", exact.s8),
    Stress("S9", "Dzhanibekov timing", "w = (1e-8,1,1e-8)", exact.s9),
    Stress("S10", "symmetric", "and within 4e-16 of it", exact.s10),
    Stress("S11", "symmetric tie, steady", "I = (3,1,1), w across the axis; w = 0", exact.s11),
    Stress("S12", "near steady", "w = (1e-9,1e-9,1), to 1e-150", exact.s12),
    Stress("S13", "near spherical", "I = (1,1+1e-10,1+3e-10)", exact.s13),
    Stress("S14", "extreme inertia", "needles to 1e-12, plates", exact.s14),
    Stress("S15", "scaling", "w 2^-530, t 2^530, I 2^400", exact.s15),
    Stress("S16", "magnitudes", "w 3e8, I 1e200, w 1e-160", exact.s16),
    Stress("S17", "sup-norm trap", "w = (1e-3,1e-3,W), tolerance 1e-9", stepping.s17),
    Stress("S18", "Lagrange cusps, loops, waves", "A = 1, C = .5, M = 1", exact.s18, quick=False),
    Stress("S19", "pendulums", "C w3 = 0", exact.s19),
    Stress("S20", "through the vertical", "start at theta = 0, pi", exact.s20, quick=False),
    Stress("S21", "sleeping top", "w3 = 4.5 .. 3, tilt 1e-3 .. 1e-7", exact.s21, quick=False),
    Stress("S22", "norm sensitivity", "q0 (1 +- 1e-15)", exact.s22),
    Stress("S23", "fast spin", "w3 = 50, 500", exact.s23),
    Stress("S24", "asymmetric top accuracy", "t = 200", stepping.s24),
    Stress("S25", "convergence order", "fixed step, asymmetric top", order.s25, quick=False),
    Stress("S26", "Taylor equals closed form", "tolerance 1e-15", stepping.s26),
    Stress("S27", "Brouwer", "free plate, no projection", stepping.s27),
    Stress("S28", "fast-math canary", "", stepping.s28),
    Stress("S29", "projection safety", "t = 200, projected every 4 steps", stepping.s29, quick=False),
    Stress("S30", "projection gain", "free plate", stepping.s30),
    Stress("S31", "invariants", "no projection", stepping.s31),
    Stress("S32", "time reversal", "heavy top, carry kept", stepping.s32),
    Stress("S33", "parameter rounding", "series with exact and with rounded coefficients", stepping.s33, quick=False),
    Stress("S34", "Euler pass-by", "I = (1,1.2,2), w = (0,.4,1)", stepping.s34),
    Stress("S35", "Euler output", "near gimbal lock", conversions.s35),
    Stress("S36", "log, exp near 0", "random axes", conversions.s36),
    Stress("S37", "log, exp near pi", "pi - 1e-1 .. pi", conversions.s37),
    Stress("S38", "conventions", "signs, frames, orders", conversions.s38),
    Stress("S39", "dense output", "random, sorted, repeated, both sides", stepping.s39),
    Stress("S40", "speed guards", "against heyoka, interleaved", speed.s40, quick=False),
    Stress("S41", "instruction sets", "those of this processor", speed.s41),
    Stress("S42", "non-smooth torque", "restarted at the switches", stepping.s42),
)
FOUND = (  # places where a stepper was wrong once
    Stress("F1", "dependent invariants", "I = (1,1.5,1.5000001), near steady", found.f1),
    Stress("F2", "units", "to the limits of scenes", found.f2),
    Stress("F3", "from rest", "w = 0, 1e-300 .. 1e-20, heavy", found.f3),
    Stress("F4", "times in any order", "repeated, denormal, none", found.f4),
    Stress("F5", "needles", "moments 1 : 1e-12", found.f5),
    Stress("F6", "equilibria", "upright and hanging, exactly", found.f6),
    Stress("F7", "locked Euler angles", "theta = 0, pi, 1e-8", found.f7),
    Stress("F8", "switch at a sample", "declared in five ways", found.f8),
)


def verdict(figure: Figure) -> str:
    """Return the verdict on one figure."""
    return "shown" if not figure.judged else "met" if figure.good else "NOT MET"


def line(stress: Stress, figure: Figure) -> str:
    """Return one row of the table."""
    bar = f"{'>=' if figure.at_least else '<='} {figure.bar:.3g}" if figure.judged else ""
    return f"{stress.id:5}{stress.name:29}{figure.method:19}{figure.what:58}{bar:>9}{figure.reached:10.2g}  {verdict(figure)}"


def main(arguments: list[str] | None = None) -> int:
    """Run the tests and print the table."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.reference.stress", description=(__doc__ or "").split("\n")[0]
    )
    parser.add_argument("ids", nargs="*", metavar="S1 S2 ..", help="these only")
    parser.add_argument("--quick", action="store_true", help="the shorter form of each, as the test suite runs it")
    parser.add_argument("--json", action="store_true", help="print JSON")
    options = parser.parse_args(arguments)
    unknown = sorted(set(options.ids) - {stress.id for stress in STRESSES + FOUND})
    if unknown:
        parser.error(f"expected S1 to S42, F1 to F8, got {', '.join(unknown)}")
    rows, met = [], True
    if not options.json:
        print(f"{'':5}{'stress test':29}{'method':19}{'what':58}{'bar':>9}{'reached':>10}  verdict")
    for stress in STRESSES + FOUND:
        if options.ids and stress.id not in options.ids:
            continue
        began = perf_counter()
        try:
            figures = stress.run(not options.quick)
        except ImportError as error:  # heyoka, for S40
            figures = [Figure("", f"not run: {error}", 0, 0, judged=False)]
        for figure in figures:
            met &= figure.good or not figure.judged
            rows.append({"id": stress.id, "name": stress.name, "parameters": stress.parameters,
                         **figure._asdict(), "verdict": verdict(figure)})  # fmt: skip
            if not options.json:
                print(line(stress, figure), flush=True)
        sys.stderr.write(f"\r{stress.id} {perf_counter() - began:.1f} s  " if sys.stderr.isatty() else "")
    if options.json:
        print(json.dumps(rows, indent=2, default=float))
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
