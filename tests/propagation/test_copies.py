"""Propagators and trajectories pickle and copy: the copies compute the same bits, in this process and in others."""

import copy
import io
import multiprocessing
import pickle
import subprocess
import sys
from multiprocessing.pool import Pool

import numpy as np
import pytest

import symrot
from symrot.propagation.external_torque import CALLBACK
from symrot.propagation.steppers.integration_stopped import IntegrationStopped

pytestmark = pytest.mark.usefixtures("quick_compiler")
TIMES = np.linspace(0.0, 1.5, 7)
START = [0.1, 2.0, 0.3]
WAYS = {"pickle": lambda x: pickle.loads(pickle.dumps(x)), "copy": copy.copy, "deepcopy": copy.deepcopy}


def brake(t, omega, quaternion):
    return -1e-6 * omega


PROPAGATORS = {
    "exact": lambda: symrot.propagator("t_handle"),
    "taylor": lambda: symrot.propagator("t_handle", "taylor", 1e-9),
    "dop853": lambda: symrot.propagator("t_handle", "dop853"),
    "scipy": lambda: symrot.propagator("t_handle", "scipy:RK45"),
    "angles": lambda: symrot.propagator("t_handle", state="ZXZ"),
    "switched": lambda: symrot.propagator("friction_wheel"),
    "function": lambda: symrot.propagator("t_handle", torque=brake, max_step=0.5),
    "table": lambda: symrot.propagator("t_handle", torque=([0, 1, 2, 3], 1e-6 * np.eye(4, 3))),
}


def same(one, other):
    assert type(one) is type(other) and one.message == other.message and one.warnings == other.warnings
    assert (one.status, one.tolerance, one.scene, one.states) == (
        other.status,
        other.tolerance,
        other.scene,
        other.states,
    )
    for name in ("t", "y", "omega", "quaternion", "energy", "angular_momentum_space"):
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes()
    assert one.sol([0.1, 0.7]).tobytes() == other.sol([0.1, 0.7]).tobytes()
    assert [item.drift for item in one.invariants] == [item.drift for item in other.invariants]


@pytest.mark.thinned(3)
@pytest.mark.parametrize(
    "method, way", [*((method, "pickle") for method in PROPAGATORS), ("exact", "copy"), ("taylor", "deepcopy")]
)
def test_a_copy_of_a_propagator_and_of_its_trajectory_gives_the_same_bits(method, way):
    original = PROPAGATORS[method]()
    other = WAYS[way](original)
    assert other is not original and (other.scene, other.method, other.reason) == (
        original.scene,
        original.method,
        original.reason,
    )
    same(other(TIMES), original(TIMES))
    trajectory = original(TIMES, omega=START)
    same(WAYS[way](trajectory), trajectory)
    same(other(TIMES, omega=START), trajectory)


def test_a_copy_keeps_events_and_their_states():
    trajectory = symrot.propagate("t_handle", events=["omega_3 == 0", "omega_1"])
    other = pickle.loads(pickle.dumps(trajectory))
    assert other.event_kinds == trajectory.event_kinds
    for one, two in zip(other.t_events + other.y_events, trajectory.t_events + trajectory.y_events, strict=True):
        assert one.tobytes() == two.tobytes()


def test_a_deep_copy_has_arrays_of_its_own():
    trajectory = symrot.propagator("t_handle")(TIMES)
    other = copy.deepcopy(trajectory)
    other.t[0] = -1.0
    assert trajectory.t[0] == 0.0


@pytest.mark.parametrize("method", ["exact", "taylor", "switched", "table"])
def test_a_pickle_names_only_classes_of_symrot_and_of_numbers(method):
    named = set()

    class Reader(pickle.Unpickler):
        def find_class(self, module, name):
            named.add(module.partition(".")[0])
            return super().find_class(module, name)

    propagator = PROPAGATORS[method]()
    Reader(io.BytesIO(pickle.dumps((propagator, propagator(TIMES))))).load()
    assert named <= {"symrot", "numpy", "fractions", "decimal"}


def test_a_pickled_propagator_works_in_a_fresh_process_without_sympy(tmp_path):
    for method in ("exact", "taylor"):
        propagator = PROPAGATORS[method]()
        trajectory = propagator(TIMES)
        expected = trajectory.sol(0.3).tolist(), propagator(TIMES, omega=START).y.tolist(), trajectory.energy.tolist()
        (tmp_path / "made").write_bytes(pickle.dumps((propagator, trajectory, expected)))
        code = (
            "import pickle, sys, numpy as np\n"
            "propagator, trajectory, expected = pickle.load(open(sys.argv[1], 'rb'))\n"
            "t = np.linspace(0.0, 1.5, 7)\n"
            f"assert propagator(t, omega={START}).y.tolist() == expected[1]\n"
            "assert (trajectory.sol(0.3).tolist(), trajectory.energy.tolist()) == (expected[0], expected[2])\n"
            "print('sympy' in sys.modules)"
        )
        done = subprocess.run([sys.executable, "-c", code, tmp_path / "made"], capture_output=True, text=True)
        assert (done.stdout.strip(), done.stderr) == ("False", "")


@pytest.mark.parametrize("method", ["exact", "taylor"])
def test_a_pickle_of_a_trajectory_holds_its_samples_once(method):
    trajectory = PROPAGATORS[method]()(np.linspace(0.0, 1.0, 5001))
    size = len(pickle.dumps(trajectory))
    assert trajectory.y.size and trajectory.omega.size and trajectory.dcm.size and len(trajectory.rotation) == 5001
    assert size < trajectory.y.nbytes + trajectory.t.nbytes + 8000
    assert len(pickle.dumps(trajectory)) < size + 8000


def test_samples_of_a_pickled_trajectory_need_no_motion():
    trajectory = pickle.loads(pickle.dumps(PROPAGATORS["taylor"]()(TIMES)))
    assert trajectory.omega.shape == (7, 3) and trajectory.quaternion.shape == (7, 4)
    assert "_motion" not in trajectory.__dict__ and "_motion" not in trajectory._propagator.__dict__


def motion_from(rate):
    return symrot.propagator("t_handle", "taylor")(TIMES, omega=[0.0, rate, 0.1])


def test_a_pool_maps_a_function_that_returns_a_trajectory():
    motion_from(1.0)
    with Pool(1, context=multiprocessing.get_context("spawn")) as pool:
        for trajectory, rate in zip(pool.map(motion_from, [1.0, 2.0]), [1.0, 2.0], strict=True):
            same(trajectory, motion_from(rate))


def test_a_torque_that_cannot_be_pickled_is_refused_in_a_sentence_and_can_be_copied(monkeypatch):
    monkeypatch.delitem(sys.modules, "cloudpickle", raising=False)  # which pickles local functions, if it is loaded
    propagator = symrot.propagator("t_handle", torque=lambda t, omega, quaternion: -1e-6 * omega, max_step=1)
    with pytest.raises(pickle.PicklingError, match="torque: expected a function that can be pickled, such as one"):
        pickle.dumps(propagator)
    assert (copy.deepcopy(propagator)(TIMES).y == propagator(TIMES).y).all()
    function = CALLBACK(lambda t, omega, quaternion, torque, user: 0)
    propagator = symrot.propagator("t_handle", torque=function, max_step=1)
    with pytest.raises(pickle.PicklingError, match="got a C function, whose address means nothing in another process"):
        pickle.dumps(propagator)
    assert (copy.deepcopy(propagator)(TIMES).y == propagator(TIMES).y).all()


def test_an_error_that_stops_a_motion_passes_between_processes():
    error = pickle.loads(pickle.dumps(IntegrationStopped(1.0, "a pole", 2.0)))
    assert str(error) == str(IntegrationStopped(1.0, "a pole", 2.0)) and error.stop == 2.0
