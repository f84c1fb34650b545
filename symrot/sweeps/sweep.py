"""The function ``sweep``: propagates many motions of one scene with varied values into a file or into memory."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.ensemble.reading import read_times
from symrot.errors import InputError, with_hint
from symrot.files.paths import path_of
from symrot.formula.exact_numbers import show
from symrot.planning.plan import Plan, make_plan
from symrot.propagation.method import choose_method
from symrot.propagation.sensitivities.libraries import rates_of
from symrot.propagation.sensitivities.variation import structure_of
from symrot.propagation.steppers.taylor import refusal
from symrot.scene.folders import listed_folders
from symrot.scene.scene import Scene, SceneSource, load_scene
from symrot.scene.tables import read_tolerance
from symrot.sweeps.chunk import COMPLETE, IMPOSSIBLE, STOPPED, WARNED, Chunk, Job, prepared
from symrot.sweeps.cluster import run_on_cluster
from symrot.sweeps.design import Design, read_design
from symrot.sweeps.layout import MESSAGE, STATUS, TIME, Header, Store, data_frame, header_of
from symrot.sweeps.outputs import UNAVERAGED, SweepOutput, read_outputs, scene_for, variable_keys
from symrot.sweeps.processes import cores, run_here
from symrot.sweeps.statistics import Statistic, read_statistics, statistics_of
from symrot.sweeps.stores.memory_store import MemoryStore
from symrot.sweeps.stores.parquet_store import ParquetStore
from symrot.sweeps.stores.shared_store import Written
from symrot.sweeps.stores.zarr_store import ZarrStore
from symrot.sweeps.targets import OMEGA, Content, constants_of

__all__ = ["STORES", "Sweep", "sweep"]

STORES: dict[str, Callable[[Path, Header], Any]] = {".zarr": ZarrStore, ".parquet": ParquetStore}
"""For each suffix of a file, its store."""

KEEP = ("all", "statistics")
FINAL_STATE = ("omega@end",)
BLOCK = 1_000_000
MOST_WORKERS = 1024
SHOWN_REASONS = 3
LARGEST_IN_MEMORY = 4_000_000_000  # bytes of results without a file


def _silent(text: str) -> None:
    """Do nothing with a message about progress: the default of ``note`` in :func:`sweep`."""


@dataclass(frozen=True, repr=False)
class Sweep:
    """The result of :func:`sweep`: inputs, outputs, status and statistics of all trajectories.

    Attributes
    ----------
    path : Path or None
        The file with the results; None if they are in memory.
    count : int
        Number of trajectories.
    stopped, impossible : int
        Number of trajectories that stopped early, and number of trajectories whose values no body or motion can have.
    reasons : list of (int, str)
        Index and reason for at most three trajectories, the first ones that stopped early or were impossible.
    warnings : tuple of str
        Warnings about the scene, such as a hole that may reach out of the body, and one sentence with the number of
        complete trajectories whose ``message`` warns of their accuracy.

    Examples
    --------
    >>> import symrot
    >>> result = symrot.sweep("t_handle", {"omega_1": "normal(0, 0.01)"}, count=8, seed=1, workers=1)
    >>> result.count, result.stopped, result.impossible
    (8, 0, 0)
    """

    path: Path | None
    count: int
    stopped: int
    impossible: int
    reasons: list[tuple[int, str]]
    _store: Any
    warnings: tuple[str, ...] = ()

    def array(self, name: str) -> NDArray[Any]:
        """Return one array of the results; all its values are loaded into memory.

        Parameters
        ----------
        name : str
            An output such as ``"omega_1@end"``, an input such as ``"input_weight"``, ``"status"``, ``"message"``, or a
            statistic such as ``"energy_mean"``.

        Returns
        -------
        array
            Outputs at all times have the shape (trajectories, times), other outputs (trajectories,). Statistics at all
            times have the times as last axis.

        Raises
        ------
        InputError
            If there is no array with this name.
        """
        header = self._store.header
        names = [STATUS, MESSAGE, *(variable.name for variable in header.variables)]
        values: NDArray[Any] | None = self._store.table(name)
        if values is None and name in names and self._store.has(name):
            values = self._store.read(name, 0, header.count)
        if values is None:
            message = f"array: expected one of {', '.join(names)} or a statistic, got {show(name)}"
            raise InputError(with_hint(message, name, names))
        return values

    def to_xarray(self) -> Any:
        """Return the results as an xarray Dataset with units; values in a Zarr file are read when they are used."""
        if isinstance(self._store, ParquetStore):
            raise InputError("to_xarray: expected a sweep in memory or in a Zarr file, got a Parquet file")
        return self._store.dataset()

    def to_dataframe(self) -> Any:
        """Return inputs, outputs and status as a pandas DataFrame, which has all values in memory.

        The index is ``(trajectory, t)``, or ``trajectory`` if no output is stored at all times. ``attrs["units"]`` has
        the units.
        """
        dataset = self._store.dataset()
        return dataset if isinstance(self._store, ParquetStore) else data_frame(dataset, self._store.header)

    def __repr__(self) -> str:
        numbers = {"stopped early": self.stopped, "impossible": self.impossible}
        failures = "".join(f", {number} {what}" for what, number in numbers.items() if number)
        place = "in memory" if self.path is None else f"in {self.path}"
        return f"<Sweep of {self._store.header.scene}: {self.count} trajectories{failures}, {place}>"


def sweep(
    scene: SceneSource,
    vary: Mapping[str, object] | None = None,
    *,
    attitudes: str = "scene",
    sampling: str = "random",
    count: float | str | None = None,
    seed: int = 0,
    outputs: str | Sequence[str] = FINAL_STATE,
    t: ArrayLike | None = None,
    statistics: str | Sequence[str] = (),
    keep: str = "all",
    path: str | Path | None = None,
    method: str = "auto",
    tolerance: float | None = None,
    workers: int | None = None,
    scheduler: object = None,
    chunk: int | None = None,
    table_folders: str | Path | Sequence[str | Path] = (),
    progress: Callable[[int, int], None] | None = None,
    note: Callable[[str], None] = _silent,
) -> Sweep:
    """Propagate many motions of a scene with varied values, and store chosen outputs of each motion.

    The results have the same bits for any number of workers. The same call with a ``path`` continues an interrupted
    sweep.

    Parameters
    ----------
    scene : Scene, str, Path or dict
        The scene: an object, the name of a shipped scene, the path of a file, or the content of a file.
    vary : dict
        For each value that varies, its name and its law. Names: ``omega_1`` to ``omega_3``; a constant such as
        ``weight`` or ``I_xx``, as for :func:`symrot.propagate_ensemble`; a number in the scene file, such as
        ``body.mass`` or ``body.part[0].radius``. Laws: ``"normal(mean, deviation)"``, ``"uniform(low, high)"``,
        ``"loguniform(low, high)"``; grids ``"linspace(first, last, count)"``, ``"geomspace(first, last, count)"``,
        ``"values(a, b, ...)"`` or a sequence of numbers. Several grids form a product; every point of the product is
        combined with every draw of the distributions.
    attitudes : str
        ``"uniform"`` draws initial attitudes uniformly from all rotations; default: the attitude in the scene.
    sampling : str
        ``"random"``, ``"latin"`` (Latin hypercube) or ``"sobol"`` for the values that are drawn.
    count : number, optional
        Number of trajectories, a multiple of the number of grid points. It is needed if values are drawn; otherwise it
        is the number of grid points.
    seed : int
        Seed of the draws. The draws of a trajectory do not depend on workers and chunks, nor on ``count`` unless the
        sampling is ``"latin"``.
    outputs : str or sequence of str
        Quantities or components, such as ``"energy"`` at all sample times, ``"omega_1@end"``, ``"axis_z@2.5"`` (at
        2.5 s), ``"omega_3@max"``; also ``@start``, ``@min`` and ``@mean``.
    t : array, shape (m,), optional
        Sample times, s, in increasing order; default: the sample times of the scene.
    statistics : str or sequence of str
        ``"mean"`` (and standard deviation), ``"envelope"``, ``"percentiles(5, 50, 95)"``, ``"histogram(BINS)"`` of
        each output at each time, over the trajectories that have a value.
    keep : str
        ``"all"``, or ``"statistics"`` to remove the values of the trajectories at the end.
    path : str or Path, optional
        The file to write, ``NAME.zarr`` or ``NAME.parquet``; default: the results stay in memory.
    method, tolerance
        As for :func:`symrot.propagate_ensemble`.
    workers : int, optional
        Number of processes on this machine; default: the number of cores.
    scheduler : str, Client or cluster of Dask, optional
        Address of a Dask scheduler, such as ``"tcp://host:8786"``, or a client or cluster with this scheduler, whose
        workers compute instead of processes here.
    chunk : int, optional
        Number of trajectories in a chunk; it does not change the results.
    table_folders
        As for :func:`symrot.load_scene`.
    progress : callable, optional
        Called with the number of complete trajectories and the number of all.
    note : callable, optional
        Called with a text about each stage after the last chunk.

    Returns
    -------
    Sweep
        The results. Trajectories whose values no body or motion can have, and trajectories that stop early, have a
        status other than 0 and a message; outputs that could not be computed are NaN.

    Raises
    ------
    InputError
        If an argument cannot be used, or if ``path`` contains anything other than results of the same sweep.
    PropagationError
        If processes or a cluster fail again and again; complete chunks remain in the file.
    CompilerError
        If the method needs a compiler and no compiler is installed.

    Notes
    -----
    Units: SI. Convention: :mod:`symrot.conventions`.

    Examples
    --------
    >>> import symrot
    >>> result = symrot.sweep("heavy_top_loops", {"body.mass": "linspace(0.4, 0.6, 3)"}, outputs="omega_3@end")
    >>> result.array("omega_3@end").round(6).tolist()
    [200.0, 200.0, 200.0]
    """
    chosen = read_statistics(_texts(statistics, "statistics"))
    _require(keep in KEEP, "keep", f"one of {', '.join(KEEP)}", keep)
    _require(keep == "all" or bool(chosen), "keep", "statistics to compute, with keep = 'statistics'", statistics)
    target = None if path is None else _target(path, keep)
    _require(
        workers is None or scheduler is None, "workers", "None with a scheduler, which has workers of its own", workers
    )
    number = cores() if workers is None else workers
    _whole(number, "workers", MOST_WORKERS)
    if chunk is not None:
        _whole(chunk, "chunk", 10_000_000)
    folders = list(listed_folders(table_folders))
    texts = _texts(outputs, "outputs")
    job = _job(scene, vary or {}, attitudes, sampling, count, seed, texts, t, method, tolerance, folders)
    _require_averages(chosen, job.outputs)
    header = header_of(job, chunk)
    if target is None:
        _require_memory(header)
    store: Store = MemoryStore(header) if target is None else STORES[target.suffix.lower()](target, header)
    only_statistics = repr(chosen) if keep == "statistics" else ""
    if store.only_statistics:
        _require_same(store.only_statistics, only_statistics, target)
        store.finish([], only_statistics)  # removes values that a process that was stopped left
    else:
        pending = store.pending()
        done = header.count - sum(stop - start for start, stop in pending)
        if progress is not None:
            progress(done, header.count)
        for part in _chunks(job, pending, number, scheduler, store):
            if isinstance(part, Chunk):
                store.write(part)
            done += part.stop - part.start
            if progress is not None:
                progress(done, header.count)
        outputs_of_store = [each for each in header.variables if each.name in {one.name for one in job.outputs}]
        tables = statistics_of(store, chosen, outputs_of_store, note) if chosen else []
        store.finish(tables, only_statistics)
    return _result(store, target, job.scene.warnings)


def _texts(value: str | Sequence[str], where: str) -> list[str]:
    try:
        return [value] if isinstance(value, str) else list(value)
    except TypeError:
        raise InputError(f"{where}: expected a string or a list of strings, got {show(value)}") from None


def _require_averages(statistics: Sequence[Statistic], outputs: Sequence[SweepOutput]) -> None:
    """Raise InputError if a statistic is a mean or a percentile of numbers that have none, such as Euler angles."""
    averages = [statistic.name for statistic in statistics if statistic.name in ("mean", "percentiles")]
    output = next((output for output in outputs if output.quantity in UNAVERAGED), None)
    if averages and output is not None:
        raise InputError(
            f"statistics: expected outputs that have a {averages[0].removesuffix('s')}, got {output.name}: "
            f"{UNAVERAGED[output.quantity]}; take axis or dcm, or a histogram"
        )


def _chunks(
    job: Job, pending: list[tuple[int, int]], workers: int, scheduler: object, store: Store
) -> Iterator[Chunk | Written]:
    """Yield the chunk of each range of trajectories in ``pending``, or :class:`Written` if a worker has stored it."""
    if not pending:
        return iter(())
    return run_here(job, pending, workers) if scheduler is None else run_on_cluster(job, pending, scheduler, store)


def _require(condition: bool, where: str, expectation: str, value: object) -> None:
    if not condition:
        raise InputError(f"{where}: expected {expectation}, got {show(value)}")


def _require_same(present: str, statistics: str, path: Path | None) -> None:
    if present != statistics:
        raise InputError(
            f"{path}: expected the same values of `statistics` and `keep` as before, since the values of the "
            "trajectories were removed from this file; write other results to another file"
        )


def _require_memory(header: Header) -> None:
    """Raise InputError if the results that ``header`` describes are too large for memory; a file is then needed."""
    sizes = [len(header.times) if TIME in variable.dimensions else 4 for variable in header.variables]
    size = 8 * header.count * sum(sizes)
    if size > LARGEST_IN_MEMORY:
        raise InputError(
            f"path: expected a file to write, such as out.zarr, for results of up to {size / 1e9:.1f} GB, got none"
        )


def _whole(value: object, where: str, most: int) -> None:
    good = isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= most
    _require(good, where, f"a whole number from 1 to {most}", value)


def _target(path: str | Path, keep: str) -> Path:
    """Return the path of the file to write.

    Raise InputError for an unknown ending, a missing folder, or a Parquet file with ``keep`` = ``"statistics"``: values
    cannot be removed from it.
    """
    target = path_of(path, "path")
    if target.suffix.lower() not in STORES:
        raise InputError(f"-o: expected a name that ends in {', '.join(STORES)}, got {str(path)!r}")
    if not target.parent.is_dir():
        raise InputError(f"-o: expected a name in an existing folder, got {str(path)!r}")
    if target.suffix.lower() != ".zarr" and keep == "statistics":
        raise InputError(
            f"-o: expected a name that ends in .zarr for keep = statistics, which stores no values of single motions, "
            f"got {str(path)!r}"
        )
    return target


def _job(
    scene: SceneSource, vary: Mapping[str, object], attitudes: str, sampling: str, count: object,
    seed: object, texts: Sequence[str], t: ArrayLike | None, method: str, tolerance: float | None,
    folders: Sequence[str | Path],
) -> Job:  # fmt: skip
    """Return the job that the arguments of :func:`sweep` describe; ``texts`` are the outputs."""
    own = scene_for(load_scene(scene, table_folders=folders), texts)
    if own.table is not None:
        raise InputError(
            f"{own.name}: expected torques that are formulas, got a torque of kind table, which a sweep cannot have"
        )
    content = _content(own)
    _require(isinstance(vary, Mapping), "vary", "a dict of laws by name", vary)
    design = read_design(own, content, vary, attitudes, sampling, count, seed)
    times = read_times(t, own, 1)
    _require(times.ndim == 1 and len(times) > 0, "t", "times in s, shape (m,)", t)
    # the columns of the results are in this order, and @start and @end name its ends
    _require(bool((np.diff(times) >= 0).all()), "t", "sample times in increasing order", t)
    _require(isinstance(method, str), "method", "the name of a method", method)
    if method not in ("auto", "exact"):
        choose_method(make_plan(own), method)  # raises an error that lists the methods
    aim = float(own.tolerance) if tolerance is None else read_tolerance(tolerance)
    outputs = read_outputs(texts, own, times)
    keys = variable_keys(outputs)
    if keys:
        _require_derivatives(own, content, design, keys)
    return prepared(Job(design, own, content, times, outputs, method, aim, tuple(keys)))


def _require_derivatives(scene: Scene, content: Content | None, design: Design, keys: Sequence[str]) -> None:
    """Raise InputError if the motions of a sweep have no derivatives with respect to the variables ``keys``.

    A derivative is refused if its variable and the sweep both change the same constant of the equations, unless the
    variable is this constant itself. For example, the mass and the radius of a body both change its moments of inertia:
    a derivative with respect to the mass is refused if the sweep varies the radius. All derivatives are refused if the
    equations of motion have no Taylor series.
    """
    from symrot.ensemble.sensitivities import read_columns

    varying = ["quaternion"] if design.attitudes == "uniform" else []
    for axis in design.axes:
        path = axis.target.path
        if path and content is not None:
            varying += constants_of(path, scene, content)
            varying += ["omega", "quaternion"] if path[0] == "initial" else []
        else:
            varying.append("omega" if axis.target.name in OMEGA else axis.target.name)
    try:
        _, columns = read_columns(scene, keys, varying)
        rates, _ = rates_of(Plan(scene, structure_of(scene, columns, varying), ()))
        reason = refusal(rates)
    except InputError as error:
        reason = str(error).removeprefix("sensitivities: ")
    if reason:
        raise InputError(f"output: {reason}")


def _content(scene: Scene) -> Content | None:
    """Return the content of a scene's file or dict; None if the scene's body or torques were replaced later."""
    try:
        return scene.to_dict()
    except InputError:  # only values of its constants can vary
        return None


def _result(store: Store, path: Path | None, warnings: tuple[str, ...]) -> Sweep:
    stopped, impossible, warned, example = 0, 0, 0, ""
    reasons = list[tuple[int, str]]()
    count = store.header.count
    for start in range(0, count, BLOCK):
        stop = min(start + BLOCK, count)
        status: NDArray[Any] = store.read(STATUS, start, stop)
        messages: NDArray[Any] = store.read(MESSAGE, start, stop)
        stopped, impossible = stopped + int((status == STOPPED).sum()), impossible + int((status == IMPOSSIBLE).sum())
        for row in np.flatnonzero(status)[: SHOWN_REASONS - len(reasons)].tolist():
            reasons.append((start + row, str(messages[row])))
        doubtful = np.flatnonzero((messages != "") & (status == COMPLETE))
        if len(doubtful) and not example:
            first = int(doubtful[0])
            example = f"trajectory {start + first}: {str(messages[first]).removeprefix(WARNED)}"
        warned += len(doubtful)
    if warned:
        warnings = (*warnings, f"{warned} of {count} trajectories have a warning, for example {example}")
    return Sweep(path, count, stopped, impossible, reasons, store, warnings)
