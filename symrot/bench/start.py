"""How long the first result takes: `symrot run` from a cold and from a warm start, beside what it cannot do without.

``python -m symrot.bench.start [ROUNDS] [SCENE]`` runs the rounds interleaved and prints medians and ratios. A compiler
call is that of the scene's own library: kernel and stepper, with symrot's flags.
"""

import os
import subprocess
import sys
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

from symrot.codegen import library
from symrot.interface import plan
from symrot.propagation.kernels import library_source, scene_kernel

__all__ = ["main"]


def _seconds(command: list[str], environment: dict[str, str]) -> float:
    began = perf_counter()
    subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return perf_counter() - began


def main(arguments: list[str]) -> int:
    """Print the table; arguments are the number of rounds and the scene."""
    rounds = int(arguments[0]) if arguments else 7
    scene = arguments[1] if len(arguments) > 1 else "tumbling_prism"
    with TemporaryDirectory(prefix="symrot-") as directory:
        warm = os.environ | {"SYMROT_CACHE": str(Path(directory) / "warm")}
        warm.pop("PYTHONDONTWRITEBYTECODE", None)
        source = Path(directory) / "motion.c"
        found = plan(scene)
        kernel = scene_kernel(found)
        source.write_text(library_source(found, kernel), encoding="utf-8")
        compile_it = [*library.compiler().command, *library.FLAGS, str(source), "-o", f"{directory}/motion.so", "-lm"]
        run = [sys.executable, "-m", "symrot", "run", scene]
        rows = {
            "import numpy": ([sys.executable, "-c", "import numpy"], warm),
            "import sympy": ([sys.executable, "-c", "import sympy"], warm),
            "compiler call": (compile_it, warm),
            "symrot run, warm": (run, warm),
            "symrot run, cold": (run, warm),
        }
        times: dict[str, list[float]] = {name: [] for name in rows}
        _seconds(run, warm)
        for number in range(rounds):
            for name, (command, environment) in rows.items():
                if name.endswith("cold"):
                    environment = environment | {"SYMROT_CACHE": str(Path(directory) / f"cold-{number}")}
                times[name].append(_seconds(command, environment))
    middle = {name: median(values) for name, values in times.items()}
    print(f"{scene}, {rounds} interleaved rounds, median (least) seconds")
    for name, values in times.items():
        print(f"  {name:<18} {middle[name]:.3f} ({min(values):.3f})")
    print(f"  warm / import numpy                       {middle['symrot run, warm'] / middle['import numpy']:.2f}")
    both = middle["import sympy"] + middle["compiler call"]
    print(f"  cold / (import sympy + compiler call)     {middle['symrot run, cold'] / both:.2f}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
