"""Files of sweeps: the values of memory, units, and a sweep that goes on after its end at any place."""

import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import symrot
from symrot.errors import InputError
from symrot.sweeps.chunk import Chunk
from symrot.sweeps.design import Draws
from symrot.sweeps.layout import Table
from symrot.sweeps.stores.zarr_store import ZarrStore
from tests.sweeps.scenes import OUTPUTS, sweep

xarray, pandas = pytest.importorskip("xarray"), pytest.importorskip("pandas")
pytest.importorskip("zarr")
pytest.importorskip("pyarrow")
NAMES = ("a.zarr", "a.parquet")


@pytest.fixture(scope="module")
def whole():
    return sweep(statistics="mean").to_xarray().load()


@pytest.fixture(scope="module", params=NAMES)
def complete(request, tmp_path_factory):
    """Return the path of a file with the results of a whole sweep, which no test changes."""
    path = tmp_path_factory.mktemp("complete") / request.param
    sweep(path=path)
    return path


@pytest.fixture(scope="module")
def cluster():
    """Provide two Dask workers in this process, which see its files."""
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=False, dashboard_address=None
    ) as workers:
        yield workers


def values(path):
    """Return the outputs in a file by name, with shape (trajectories, times) or (trajectories,)."""
    if path.suffix == ".zarr":
        dataset = xarray.open_zarr(path)
        return {name: dataset[name].values for name in (*OUTPUTS, "input_weight", "status")}
    frame = pandas.read_parquet(path).sort_values(["trajectory", "t"])
    single = {name: frame[name].to_numpy()[::3] for name in (*OUTPUTS[1:], "input_weight", "status")}
    return {"omega_1": frame.omega_1.to_numpy().reshape(-1, 3)} | single


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", NAMES)
def test_a_file_has_the_values_of_memory(whole, tmp_path, name):
    sweep(path=tmp_path / name, chunk=7, statistics="mean")
    for key, array in values(tmp_path / name).items():
        assert np.array_equal(array, whole[key])


@pytest.mark.parametrize("name", NAMES)
def test_arrays_of_a_file_are_those_of_memory(whole, tmp_path, name):
    result = sweep(path=tmp_path / name, statistics=["mean", "percentiles(5, 50)"])
    for key in (*OUTPUTS, "input_weight", "status", "omega_1_mean", "axis_z@end_mean"):
        assert np.array_equal(result.array(key), whole[key])
    assert result.array("omega_1_percentile").shape == (2, 3) and result.array("message").tolist() == [""] * 40
    with pytest.raises(InputError, match="did you mean 'omega_1'"):
        result.array("omega_11")


@pytest.mark.parametrize("name", [None, "a.zarr", "a.parquet"])
def test_a_data_frame_has_one_row_for_each_trajectory_and_time(whole, tmp_path, name):
    """Statistics and the components of attitudes do not multiply the rows; every store gives the same frame."""
    path = None if name is None else tmp_path / name
    frame = sweep(path=path, statistics=["percentiles(5, 50, 95)", "mean"]).to_dataframe()
    assert frame.index.names == ["trajectory", "t"] and frame.shape == (40 * 3, 11)
    assert list(frame.columns[:6]) == ["input_omega_1", "input_weight", "input_q0", "input_q1", "input_q2", "input_q3"]
    assert np.array_equal(frame["omega_1"].to_numpy().reshape(40, 3), whole["omega_1"])
    assert np.array_equal(frame["input_q2"].to_numpy()[::3], whole["input_quaternion"][:, 2])
    assert np.array_equal(frame["axis_z@end"].to_numpy(), np.repeat(whole["axis_z@end"].to_numpy(), 3))
    assert frame.attrs["units"]["omega_1"] == "rad/s" and frame.attrs["units"]["t"] == "s"


@pytest.mark.parametrize("name", [None, "a.zarr", "a.parquet"])
def test_a_data_frame_without_outputs_at_all_times_has_one_row_for_each_trajectory(whole, tmp_path, name):
    path = None if name is None else tmp_path / name
    frame = sweep(path=path, outputs="axis_z@end", statistics="mean").to_dataframe()
    assert frame.index.names == ["trajectory"]
    assert np.array_equal(frame["axis_z@end"].to_numpy(), whole["axis_z@end"])


def test_pandas_and_xarray_show_units(tmp_path):
    for name in NAMES:
        sweep(path=tmp_path / name, statistics="mean")
    assert xarray.open_zarr(tmp_path / "a.zarr").omega_1.attrs["units"] == "rad/s"
    frame = pandas.read_parquet(tmp_path / "a.parquet")
    assert frame.attrs["units"]["energy@max"] == "J" and {"t", "input_q0", "message"} <= set(frame)
    table = pandas.read_parquet(tmp_path / "a.parquet" / "_statistics.parquet")
    mean = table[(table.name == "omega_1_mean") & (table.t == 0.5)].value.item()
    assert mean == float(xarray.open_zarr(tmp_path / "a.zarr").omega_1_mean[1])


@pytest.mark.parametrize("name", [None, *NAMES])
def test_statistics_have_one_value_for_each_of_equal_sample_times(tmp_path, name):
    path = None if name is None else tmp_path / name
    result = sweep(path=path, outputs="energy", t=[0.0, 0.5, 0.5], statistics=["mean", "percentiles(5, 50)"])
    mean, percentiles = result.array("energy_mean"), result.array("energy_percentile")
    assert mean.shape == (3,) and percentiles.shape == (2, 3) and mean[1] == mean[2]


class Stop(Exception):
    pass


@pytest.mark.parametrize("name", NAMES)
def test_a_sweep_that_stopped_goes_on_and_computes_nothing_twice(whole, tmp_path, name):
    def stop_after(number):
        def show(done, total):
            if done >= number:
                raise Stop

        return show

    for number in (10, 30):
        with pytest.raises(Stop):
            sweep(path=tmp_path / name, chunk=10, progress=stop_after(number))
    calls = []
    sweep(path=tmp_path / name, chunk=3, progress=lambda done, total: calls.append(done))
    assert calls == [30, 40]  # the chunks are those of the first call
    assert all(np.array_equal(array, whole[key]) for key, array in values(tmp_path / name).items())


def test_a_chunk_without_a_status_is_computed_again(whole, tmp_path):
    """A process that ends while it writes leaves values without a status, which is written last."""
    path = tmp_path / "a.zarr"
    sweep(path=path, chunk=10)
    (path / "status" / "c" / "2").unlink()
    (path / "omega_1" / "c" / "2" / "0").unlink()
    calls = []
    sweep(path=path, progress=lambda done, total: calls.append(done))
    assert calls == [30, 40] and np.array_equal(values(path)["omega_1"], whole.omega_1)


@pytest.mark.parametrize("name", NAMES)
def test_a_full_disk_loses_nothing(whole, tmp_path, name, monkeypatch):
    store = symrot.sweeps.sweep.STORES[Path(name).suffix]
    write, calls = store.write, []

    def full(self, chunk):
        calls.append(chunk.start)
        if len(calls) == 3:
            raise OSError(28, "No space left on device", str(self.path))
        write(self, chunk)

    monkeypatch.setattr(store, "write", full)
    with pytest.raises(OSError, match="No space left"):
        sweep(path=tmp_path / name, chunk=10)
    sweep(path=tmp_path / name, chunk=10)
    assert calls == [0, 10, 20, 20, 30]
    assert all(np.array_equal(array, whole[key]) for key, array in values(tmp_path / name).items())


@pytest.mark.parametrize(
    ("options", "word"),
    [({"seed": 8}, "seed"), ({"count": 45}, "count"), ({"outputs": "omega_2"}, "output"), ({"t": [0.0, 1.0]}, "times"),
     ({"vary": {"omega_1": "normal(0, 0.2)"}}, "vary"), ({"tolerance": 1e-5}, "tolerance")],
)  # fmt: skip
def test_results_of_another_sweep_are_refused(complete, options, word):
    with pytest.raises(
        InputError, match=f"got the results of a sweep with a different .*{word}.*; choose another name"
    ):
        sweep(path=complete, **options)


@pytest.mark.parametrize("name", NAMES)
def test_other_files_are_refused_and_stay(tmp_path, name):
    (tmp_path / name).mkdir()
    (tmp_path / name / "letter.txt").write_text("dear reader")
    with pytest.raises(InputError, match="got a file or folder with other content"):
        sweep(path=tmp_path / name)
    assert (tmp_path / name / "letter.txt").read_text() == "dear reader"


def test_statistics_alone_leave_no_values(tmp_path):
    path = tmp_path / "a.zarr"
    for _ in range(2):  # the second call finds the sweep complete
        result = sweep(path=path, statistics="envelope", keep="statistics")
    assert result.count == 40 and "omega_1" not in result.to_xarray() and not (path / "omega_1").exists()


@pytest.mark.parametrize("options", [{"statistics": "mean", "keep": "statistics"}, {"statistics": "envelope"}, {}])
def test_values_that_were_removed_are_not_taken_for_results(tmp_path, options):
    sweep(path=tmp_path / "a.zarr", statistics="envelope", keep="statistics")
    with pytest.raises(InputError, match="the values of the trajectories were removed"):
        sweep(path=tmp_path / "a.zarr", **options)


COMMAND = (
    "import sys, symrot; from tests.sweeps.scenes import sweep; sys.stdout.reconfigure(line_buffering=True);"
    "sweep(path=sys.argv[1], count=1000, chunk=20, workers=int(sys.argv[2]), progress=lambda done, total: print(done))"
)


def test_a_client_killed_at_two_places_loses_nothing(tmp_path):
    path, places = tmp_path / "a.zarr", []
    for _ in range(2):
        with subprocess.Popen(
            [sys.executable, "-c", COMMAND, str(path), "1"], stdout=subprocess.PIPE, text=True, env=os.environ
        ) as process:
            assert process.stdout is not None
            places.append(int(process.stdout.readline()))
            for _ in range(5):
                process.stdout.readline()
            process.kill()
    assert 0 == places[0] < places[1] < 1000
    sweep(path=path, count=1000)
    whole = sweep(count=1000, workers=1).to_xarray()
    assert all(np.array_equal(array, whole[key]) for key, array in values(path).items())


def test_a_killed_worker_costs_only_its_chunks(tmp_path):
    """The process of a worker is killed after the first chunk; the sweep ends with all its rows."""
    import multiprocessing

    killed = []

    def kill_once(done, total):
        if done and not killed:
            child = next(iter(multiprocessing.active_children()))
            killed.append(child.pid)
            child.kill()

    result = sweep(count=200, chunk=10, workers=2, progress=kill_once)
    assert killed and np.array_equal(result.to_xarray().omega_1, sweep(count=200).to_xarray().omega_1)


def test_workers_end_with_a_killed_client(tmp_path):
    with subprocess.Popen(
        [sys.executable, "-c", COMMAND.replace("print(done)", "print(done, *[p.pid for p in "
         "__import__('multiprocessing').active_children()])"), str(tmp_path / "a.zarr"), "2"],
        stdout=subprocess.PIPE, text=True, env=os.environ,
    ) as process:  # fmt: skip
        assert process.stdout is not None
        process.stdout.readline()
        children = [int(word) for word in process.stdout.readline().split()[1:]]
        process.kill()
    assert len(children) == 2
    for _ in range(500):
        if not any(
            Path(f"/proc/{child}/cmdline").exists() and Path(f"/proc/{child}/cmdline").read_bytes()
            for child in children
        ):
            break
        time.sleep(0.02)
    else:
        pytest.fail("a worker went on without its client")


def test_a_dask_cluster_gives_the_same_bits(whole, cluster):
    from distributed import Client

    results = [sweep(scheduler=cluster.scheduler_address, chunk=10, statistics="mean")]
    with Client(cluster) as client:
        results += [sweep(scheduler=each, chunk=10, statistics="mean") for each in (cluster, client)]
    for result in results:
        xarray.testing.assert_identical(result.to_xarray(), whole)


def test_processes_here_beside_a_scheduler_are_refused():
    with pytest.raises(
        InputError, match="workers: expected None with a scheduler, which has workers of its own, got 2"
    ):
        sweep(scheduler="tcp://127.0.0.1:9", workers=2)


def test_a_scheduler_that_does_not_answer_is_one_sentence(monkeypatch):
    pytest.importorskip("distributed")
    from symrot.sweeps import cluster

    monkeypatch.setattr(cluster, "SECONDS", 1)
    with pytest.raises(InputError, match=r"--scheduler: expected the address of a Dask scheduler"):
        sweep(scheduler="tcp://127.0.0.1:9")


@pytest.mark.parametrize("address", ["foo", "tcp://foo", "http://foo:1", 8786])
def test_an_address_of_no_scheduler_is_refused_at_once(address):
    """No client is made, which would wait for a minute when the process ends."""
    pytest.importorskip("distributed")
    began = time.perf_counter()
    with pytest.raises(InputError, match=r"--scheduler: expected the address of a Dask scheduler"):
        sweep(scheduler=address)
    assert time.perf_counter() - began < 20


def test_the_description_names_what_identifies_a_sweep(tmp_path):
    sweep(path=tmp_path / "a.parquet")
    identity = json.loads((tmp_path / "a.parquet" / "_sweep.json").read_text())["identity"]
    assert {"scene", "vary", "seed", "count", "times", "output"} <= set(identity)
    assert ZarrStore.__doc__


def test_a_parquet_file_has_only_the_arrays_of_its_header(tmp_path):
    pytest.importorskip("pyarrow")
    result = sweep(path=tmp_path / "out.parquet", count=5)
    store = result._store
    assert store.has("status") and store.has(OUTPUTS[0]) and not store.has("no such array")
    with pytest.raises(InputError, match="expected one of status"):
        result.array("no such array")


@pytest.mark.skipif(not Path("/proc/sys/kernel/random/boot_id").exists(), reason="only on Linux")
@pytest.mark.parametrize("name", NAMES)
def test_workers_on_this_machine_write_their_chunks(whole, cluster, tmp_path, monkeypatch, name):
    from symrot.sweeps import cluster as module

    parts = []
    run = module.stored
    monkeypatch.setattr(module, "stored", lambda *given: parts.append(run(*given)) or parts[-1])
    sweep(scheduler=cluster.scheduler_address, chunk=5, path=tmp_path / name, statistics="mean")
    assert sorted(parts) == [(start, start + 5) for start in range(0, 40, 5)]
    for key, array in values(tmp_path / name).items():
        assert np.array_equal(array, whole[key])
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_worker_that_cannot_write_sends_its_chunk(whole, cluster, tmp_path, monkeypatch):
    from symrot.sweeps.stores import shared_store

    monkeypatch.setattr(shared_store, "_opened", lambda store, mark: 1 / 0)
    sweep(scheduler=cluster.scheduler_address, chunk=5, path=tmp_path / "a.zarr")
    for key, array in values(tmp_path / "a.zarr").items():
        assert np.array_equal(array, whole[key])


def test_a_worker_writes_only_for_its_own_client_while_that_runs(tmp_path):
    from symrot.sweeps.stores.shared_store import BOOT, Written, offered, stored

    if not BOOT.exists():
        pytest.skip("only on Linux")
    store = sweep(path=tmp_path / "a.zarr", chunk=5)._store
    part = Chunk(0, 5, Draws(np.zeros((5, 2)), np.zeros((5, 4))), {}, np.full(5, -1, np.int8), {})
    with offered(store) as offer:
        assert stored(part, offer) == Written(0, 5)
        assert store.read("status", 0, 6).tolist() == [-1] * 5 + [0]
    with offered(store) as later:
        # the last: another folder of the same name, as in a container
        for wrong in (
            offer, later._replace(mark="other machine"), later._replace(file=str(tmp_path / "none")),
            later._replace(folder=(0, later.folder[1])),
        ):  # fmt: skip
            assert stored(part, wrong) is part
    assert stored(part, later) is part  # its client has ended


def test_a_client_that_is_killed_leaves_no_other_file_than_its_results(tmp_path):
    """The file .a.zarr.lock stayed after a client was killed."""
    from symrot.sweeps.stores.shared_store import offered

    store = sweep(path=tmp_path / "a.zarr", chunk=5)._store
    with offered(store):
        assert [path.name for path in tmp_path.iterdir()] == ["a.zarr"]


def test_statistics_of_values_that_another_process_removed_are_not_stored(tmp_path):
    """The mean became NaN: the second process computed it from an array whose chunks were removed."""
    path = tmp_path / "a.zarr"
    before = sweep(path=path, statistics="envelope")._store
    only = sweep(path=path, statistics="envelope", keep="statistics")
    means = {
        name: values.copy() for name, values in only.to_xarray().load().data_vars.items() if name.startswith("omega")
    }
    store = ZarrStore(path, before.header)
    wrong = [Table(name, values.dims, np.full(values.shape, np.nan), {}) for name, values in means.items()]
    store.finish(wrong, store.only_statistics)
    after = sweep(path=path, statistics="envelope", keep="statistics").to_xarray().load()
    assert means and all(np.array_equal(after[name].values, values.values) for name, values in means.items())
    with pytest.raises(InputError, match="kept only its statistics"):
        store.finish(wrong, "")


@pytest.mark.parametrize("name", NAMES)
def test_a_folder_that_was_begun_again_with_another_seed_takes_no_chunk_of_the_old_sweep(tmp_path, name):
    path = tmp_path / name
    old = symrot.sweep("t_handle", {"omega_1": "normal(0, 1)"}, count=8, seed=1, path=path, workers=1, chunk=4)
    chunk = Chunk(0, 4, Draws(np.zeros((4, 1)), None), {"omega@end": np.zeros((4, 4))}, np.zeros(4, np.int8), {})
    shutil.rmtree(path)
    new = symrot.sweep("t_handle", {"omega_1": "normal(0, 1)"}, count=8, seed=2, path=path, workers=1, chunk=4)
    before = new.array("omega_1@end")
    with pytest.raises(InputError, match="got the results of a sweep with a different seed; choose another name"):
        old._store.write(chunk)
    with pytest.raises(InputError, match="different seed"):
        old._store.finish([], "")
    assert np.array_equal(new.array("omega_1@end"), before)


@pytest.mark.parametrize("name", NAMES)
def test_a_folder_that_was_begun_again_with_other_chunks_takes_none_of_the_old_ones(tmp_path, name):
    path = tmp_path / name
    old = sweep(path=path)
    shutil.rmtree(path)
    sweep(path=path, chunk=old._store.header.rows + 1)
    with pytest.raises(InputError, match=r"got chunks of \d+, because another run has begun the sweep anew"):
        old._store.finish([], "")


@pytest.mark.parametrize("name", NAMES)
def test_two_clients_that_create_one_folder_at_once_share_it(whole, tmp_path, name, monkeypatch):
    """The second client finds no folder, and when its own one is complete, the folder of the first one exists."""
    path, exists = tmp_path / name, Path.exists
    sweep(path=path)
    answers = iter([False])
    monkeypatch.setattr(Path, "exists", lambda self: next(answers, exists(self)) if self == path else exists(self))
    second = sweep(path=path)
    assert np.array_equal(second.array("omega_1"), whole.omega_1.values)
    assert [each.name for each in tmp_path.iterdir()] == [name]
