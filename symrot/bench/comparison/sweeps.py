"""Time of a sweep against the same motions by propagate_ensemble alone, and of one Dask worker against two.

    python -m symrot.bench.comparison.sweeps [--count 1e6] [--seconds 10] [--rounds 3]

Every motion is a damped heavy top with its own rate and weight; a sweep writes three quantities at 11 times to a Zarr
file. A sweep also computes outputs, writes files and starts processes; the longer the motions, the smaller the share of
this work. All contestants use the same number of cores, one after the other in each round; the median of the ratios
counts. On a busy machine, the processor times of client, scheduler and workers show the largest speed-up that a second
Dask worker can give.

``pip install 'symrot[sweep,cluster]'`` installs what is needed.
"""

import argparse
import os
import resource
import sys
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter, process_time
from typing import Any, NamedTuple

import numpy as np

import symrot
from symrot.report.layout import columns
from symrot.sweeps.processes import cores

__all__ = ["TOP", "VARY", "main"]

TOP: dict[str, Any] = {
    "schema": 1,
    "body": {"principal": [1, 1, "1/2"], "about": "fixed_point", "center_of_mass": [0, 0, "1/2"]},
    "initial": {"omega": ["1/10", "1/5", 20], "attitude": {"sequence": "ZXZ", "angles": [0, "1/2", 0]}},
    "torque": [{"kind": "gravity", "weight": 20}, {"kind": "damping", "linear": "1/100"}],
}
"""Scene of a damped heavy top, whose motion has no closed form; the key ``span`` (times) is added for each run."""

VARY = {"omega_1": "normal(0.1, 0.1)", "weight": "uniform(15, 25)"}
OUTPUTS = ("omega_1", "axis_z", "energy")
QUIET = {"distributed.admin.tick.interval": "1s", "distributed.admin.system-monitor.interval": "5s"}
"""Settings of Dask: a cluster measures its latency every second and its memory every 5 s.

Dask's defaults are 50 and 2 times a second."""

PART = 100_000  # motions of one call of propagate_ensemble, so that its results fit in memory


Scene = dict[str, Any]


def _ensembles(scene: Scene, count: int, workers: int) -> float:
    """Return the seconds that ``propagate_ensemble`` takes for ``count`` tops with ``workers`` threads."""
    random = np.random.default_rng(7)
    begin = perf_counter()
    for start in range(0, count, PART):
        n = min(PART, count - start)
        omega = np.column_stack([random.normal(0.1, 0.1, n), np.full(n, 0.2), np.full(n, 20.0)])
        parameters = {"weight": random.uniform(15, 25, n)}
        symrot.propagate_ensemble(scene, omega=omega, parameters=parameters, workers=workers)
    return perf_counter() - begin


def _sweep(scene: Scene, count: int, workers: int | None, scheduler: str | None = None) -> float:
    """Return the seconds of a sweep of ``count`` tops into a new Zarr file."""
    with TemporaryDirectory(prefix="symrot-") as folder:
        begin = perf_counter()
        symrot.sweep(
            scene, VARY, count=count, seed=7, outputs=OUTPUTS, path=Path(folder, "tops.zarr"),
            workers=workers, scheduler=scheduler,
        )  # fmt: skip
        return perf_counter() - begin


class Cost(NamedTuple):
    """The cost of a sweep on a cluster, in s: elapsed time, and the processor times of client and of workers.

    The scheduler runs in the process of the client.
    """

    seconds: float
    client: float
    workers: float

    @property
    def attainable(self) -> float:
        """The largest factor, such as 1.8, by which a second Dask worker can speed up the sweep on two cores.

        Client, scheduler and both workers share the two cores. A single worker needs its own processor time; two cores
        need at least half of the processor time of all.
        """
        return 2 / (1 + self.client / self.workers)


def _on_cluster(scene: Scene, count: int, workers: int) -> Cost:
    """Return the cost of a sweep by ``workers`` Dask workers with one thread each.

    Before the measurement the workers run a short sweep, so that starting and compiling do not count.
    """
    import dask
    from distributed import Client, LocalCluster

    with (
        dask.config.set(QUIET),
        LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
    ):
        address = cluster.scheduler_address
        _sweep(scene, 2048 * workers, None, address)
        with Client(address, set_as_default=False) as client:
            before, began = sum(client.run(process_time).values()), process_time()
            seconds = _sweep(scene, count, None, address)
            return Cost(seconds, process_time() - began, sum(client.run(process_time).values()) - before)


def _peak() -> float:
    """Return the largest memory, in MB, that one process has used: this one, or one of its finished child processes."""
    unit = 1e6 if sys.platform == "darwin" else 1e3
    return max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)) / unit


def main() -> None:
    """Print a table with a row for each repetition: times of ``propagate_ensemble`` and ``sweep``, ratios, memory.

    ``symrot.sweep`` runs the same motions without Dask, with one Dask worker and with two. The last row has the medians
    of the ratios.
    """
    parser = argparse.ArgumentParser(description="sweeps against propagate_ensemble, and two Dask workers against one")
    parser.add_argument("--count", type=float, default=1e6)
    parser.add_argument("--seconds", type=float, default=10, help="length of each motion, s")
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    count, number = int(options.count), cores()
    os.environ.setdefault("DASK_LOGGING__DISTRIBUTED", "error")
    scene = TOP | {"span": {"t": [0, options.seconds], "samples": 11}}
    _sweep(scene, 2048, number)  # compiles the kernel
    rows = [("round", "propagate_ensemble", "sweep", "ratio", "memory", "1 Dask worker", "2 Dask workers", "ratio",
             "processor time of workers", "of client and scheduler", "attainable")]  # fmt: skip
    ratios: list[tuple[float, float, float]] = []
    for turn in range(options.rounds):
        alone, sweep = _ensembles(scene, count, number), _sweep(scene, count, number)
        memory = _peak()
        one, two = _on_cluster(scene, count, 1), _on_cluster(scene, count, 2)
        ratios.append((sweep / alone, one.seconds / two.seconds, two.attainable))
        rows.append((str(turn + 1), f"{alone:.1f} s", f"{sweep:.1f} s", f"{sweep / alone:.2f}", f"{memory:.0f} MB",
                     f"{one.seconds:.1f} s", f"{two.seconds:.1f} s", f"{one.seconds / two.seconds:.2f}",
                     f"{two.workers:.1f} s", f"{two.client:.1f} s", f"{two.attainable:.2f}"))  # fmt: skip
    sweeps, workers, attainable = (median(each) for each in zip(*ratios, strict=True))
    rows.append(("median", "", "", f"{sweeps:.2f}", "", "", "", f"{workers:.2f}", "", "", f"{attainable:.2f}"))
    print(f"{count} damped tops over {options.seconds:g} s, three quantities at 11 times each, {number} cores")
    print("\n".join(columns(rows)))


if __name__ == "__main__":
    main()
