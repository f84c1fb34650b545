"""Time of a whole `symrot run` from the shell, with a filled and with an empty cache, and of its unavoidable parts.

    python -m symrot.bench.start [ROUNDS] [SCENE]

The result is the median ratio to ``python -c 'import numpy'`` in the same round. Starts with an empty cache are timed
in every tenth round.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

from symrot.build import cache
from symrot.propagation.compiled_models import library_source, scene_kernel
from symrot.workshop.emit import plan

__all__ = ["main"]

ROUNDS = 21
COLD_EVERY = 10


def _seconds(command: list[str], environment: dict[str, str]) -> float:
    began = perf_counter()
    subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return perf_counter() - began


def _symrot() -> list[str]:
    """Return the command line of symrot: the script next to this Python, otherwise ``python -m symrot``."""
    script = Path(sys.executable).with_name("symrot")
    return [str(script)] if script.exists() else [sys.executable, "-m", "symrot"]


def main(arguments: list[str] | None = None) -> None:
    """Print how long ``symrot run`` takes from the shell, and how long its parts take, such as ``import numpy``."""
    parser = argparse.ArgumentParser(prog="python -m symrot.bench.start", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("rounds", type=int, nargs="?", default=ROUNDS)
    parser.add_argument("scene", nargs="?", default="tumbling_prism", help="a shipped scene, or a file")
    options = parser.parse_args(arguments)
    rounds, scene = options.rounds, options.scene
    if rounds < 1:
        parser.error(f"rounds: expected a number from 1 on, got {rounds}")
    with TemporaryDirectory(prefix="symrot-") as directory:
        warm = os.environ | {"SYMROT_CACHE": str(Path(directory) / "warm")}
        warm.pop("PYTHONDONTWRITEBYTECODE", None)
        source = Path(directory) / "motion.c"
        scene_plan = plan(scene)
        kernel = scene_kernel(scene_plan)
        source.write_text(library_source(scene_plan, kernel), encoding="utf-8")
        compile_it = [*cache.compiler().command, *cache.FLAGS, str(source), "-o", f"{directory}/motion.so", "-lm"]
        numpy, run = [sys.executable, "-c", "import numpy"], [*_symrot(), "run", scene]
        rows: dict[str, list[float]] = {"import numpy": [], "symrot run, warm": []}
        rows |= {"import sympy": [], "compiler call": [], "symrot run, cold": []}
        _seconds(run, warm)
        for number in range(rounds):
            rows["import numpy"].append(_seconds(numpy, warm))
            rows["symrot run, warm"].append(_seconds(run, warm))
            if number % COLD_EVERY == 0:
                cold = warm | {"SYMROT_CACHE": str(Path(directory) / f"cold-{number}")}
                rows["import sympy"].append(_seconds([sys.executable, "-c", "import sympy"], warm))
                rows["compiler call"].append(_seconds(compile_it, warm))
                rows["symrot run, cold"].append(_seconds(run, cold))
    middle = {name: median(values) for name, values in rows.items()}
    print(f"{scene}, {rounds} rounds: median (least) seconds of `{' '.join(run)}` and others")
    for name, values in rows.items():
        print(f"  {name:<18} {middle[name]:.3f} ({min(values):.3f})")
    pairs = zip(rows["symrot run, warm"], rows["import numpy"], strict=True)
    ratio = median(one / other for one, other in pairs)
    print(f"  symrot run, warm, divided by import numpy: {ratio:.2f} (median of the ratios)")
    both = middle["import sympy"] + middle["compiler call"]
    print(f"  symrot run, cold, divided by import sympy + compiler call: {middle['symrot run, cold'] / both:.2f}")


if __name__ == "__main__":
    main()
