"""Torques with narrow features, in time and in the states: no step passes over a feature, and dense output agrees.

A torque of time about the axis of rotation changes omega by its impulse, a torque of the angle by its work. Tumbling
bodies are compared with the campaign's reference, which is told where the features are.
"""

from math import cos, cosh, erf, exp, log, pi, sqrt

import mpmath
import numpy as np
import pytest
from scipy.special import erf as erfs
from scipy.special import ive

import symrot
from symrot.errors import PropagationError
from tests.campaigns.torques.collocation import Feature
from tests.campaigns.torques.references import Problem, attitude_apart, reference

pytestmark = pytest.mark.usefixtures("quick_compiler")
ALLOWED = 20  # tolerances, as promised
STEPPED = ("auto", "dop853")  # auto takes Taylor series here


def scene(torque, parameters=None, omega=(0, 0, 0), stop=4.0, moments=(1, 2, 3)):
    torque = ["0", "0", torque] if isinstance(torque, str) else list(torque)
    return symrot.Scene.from_dict({
        "schema": 1, "body": {"principal": list(moments)}, "initial": {"omega": list(omega)}, "span": {"t": [0, stop]},
        "torque": [{"kind": "expression", "torque": torque, "parameters": parameters or {}}],
    })  # fmt: skip


def rates(trajectory, times):
    """Return the times and omega_3 at the samples, with more times from dense output."""
    dense = np.sort(np.random.default_rng(5).uniform(times[0], times[-1], 200))
    return np.concatenate([trajectory.t, dense]), np.concatenate([trajectory.omega[:, 2], trajectory.sol(dense)[2]])


def log_cosh(x):
    x = np.abs(x)
    return x + np.log1p(np.exp(-2 * x)) - log(2)


IMPULSES = {  # torque of t, c and w -> its integral from 0
    "(1+tanh((t-c)/w))/2": lambda t, c, w: (t + w * (log_cosh((t - c) / w) - log_cosh(c / w))) / 2,
    "exp(-((t-c)/w)**2)": lambda t, c, w: w * sqrt(pi) / 2 * (erfs((t - c) / w) + erf(c / w)),
    "1/cosh((t-c)/w)**2": lambda t, c, w: w * (np.tanh((t - c) / w) + np.tanh(c / w)),
    "(t-c)/w*exp(-((t-c)/w)**2)": lambda t, c, w: -w / 2 * (np.exp(-(((t - c) / w) ** 2)) - exp(-((c / w) ** 2))),
    "1/(1+((t-c)/w)**2)": lambda t, c, w: w * (np.arctan((t - c) / w) + np.arctan(c / w)),
}


@pytest.mark.parametrize("method", STEPPED)
@pytest.mark.parametrize(("function", "exponent"), [("sin", 6), ("cos", 10)])
def test_pulses_at_the_zeros_of_a_wave_keep_the_tolerance(method, function, exponent):
    """Rounded near pi, the phase is wrong by a visible part of a pulse: omega_3 was off by up to 1e7 tolerances.

    The integral of 1/(sin(u)^2 + w^2) is atan(sqrt(1 + 1/w^2) tan(u))/(w sqrt(1 + w^2)), on all branches.
    """
    tolerance, w = 1e-12, mpmath.mpf(10) ** -exponent
    made = scene(f"w/({function}(t + 1)**2 + w**2)", {"w": f"1e-{exponent}"}, stop=20.0, moments=(1, 1, 1))
    trajectory = symrot.propagate(made.with_(samples=41), method=method)
    with mpmath.workdps(40):

        def impulse(t):
            phase = mpmath.mpf(t) + 1 + (mpmath.pi / 2 if function == "cos" else 0)
            branch = mpmath.floor(phase / mpmath.pi + mpmath.mpf(1) / 2)
            return (mpmath.atan(mpmath.sqrt(1 + 1 / w**2) * mpmath.tan(phase)) + branch * mpmath.pi) / mpmath.sqrt(
                1 + w**2
            )

        expected = np.array([float(impulse(t) - impulse(0)) for t in trajectory.t])
    assert np.abs(trajectory.omega[:, 2] - expected).max() < tolerance * np.abs(expected).max()


def impulse_of_pulse(phase, zero, w, stop):
    """Return the integral of w/(phase(t)^2 + w^2) from 0, for the only zero of the phase, by quadrature."""
    with mpmath.workdps(30):
        places = [zero + side * w * 10**k for k in range(12) for side in (-1, 1)]
        ends = sorted([0, zero, stop, *(place for place in places if 0 < place < stop)])
        return float(mpmath.quad(lambda t: w / (phase(t) ** 2 + w**2), ends))


PHASES = {  # phase -> its function, its zero, and the tolerance that its rounding allows for w = 1e-6
    "t**2 - 25": (lambda t: t**2 - 25, lambda: mpmath.mpf(5), 1e-7),
    "exp(t/5) - 2": (lambda t: mpmath.exp(t / 5) - 2, lambda: 5 * mpmath.log(2), 1e-9),
    "log(t + 1) - 1": (lambda t: mpmath.log(t + 1) - 1, lambda: mpmath.e - 1, 1e-9),
    "sin(t/6) - 1/2": (lambda t: mpmath.sin(t / 6) - mpmath.mpf(1) / 2, lambda: mpmath.pi, 1e-10),
}


@pytest.mark.thinned(2)
@pytest.mark.parametrize("method", STEPPED)
@pytest.mark.parametrize("phase", PHASES)
def test_a_pulse_is_followed_as_exactly_as_its_phase_is_rounded(phase, method):
    """exp(t/5) - 2 is rounded by 4e-16, 4e-10 of the width 1e-6: enough for one tolerance, not for a narrower pulse.

    Taylor motions were wrong by up to 5e6 tolerances for w = 1e-10.
    """
    function, zero, tolerance = PHASES[phase]
    with mpmath.workdps(30):
        impulse = impulse_of_pulse(function, zero(), mpmath.mpf(10) ** -6, 8)
    made = scene(f"w/(({phase})**2 + w**2)", {"w": "1e-6"}, stop=8.0, moments=(1, 1, 1))
    trajectory = symrot.propagate(made.with_(tolerance=tolerance), method=method)
    assert trajectory.omega[-1, 2] == pytest.approx(impulse, rel=ALLOWED * tolerance)
    assert trajectory.stats.accepted < 1000
    with pytest.raises(PropagationError, match="cannot be followed"):
        symrot.propagate(made.with_({"w": "1e-10"}), method=method)


def fresnel(t):
    """Return the integral of sin(t^2)."""
    return float(mpmath.sqrt(mpmath.pi / 2) * mpmath.fresnels(mpmath.sqrt(2 / mpmath.pi) * mpmath.mpf(t)))


@pytest.mark.parametrize(
    ("method", "stop", "follow"),
    [("taylor", 20, "alone"), ("dop853", 20, "alone"), ("scipy:DOP853", 9, "alone"), ("taylor", 20, "in angles"),
     ("taylor", -20, "switched"), ("scipy:DOP853", 9, "switched")],
)  # fmt: skip
def test_where_the_rounding_of_a_phase_exceeds_the_tolerance_a_warning_says_so(method, stop, follow):
    """sin(t^2): t^2 is rounded by up to 1e-16 t^2 rad. Motions were off by up to 100 tolerances in silence.

    At 100 times the tolerance, no warning appears.
    """
    switch = " + step(t)/1000 - step(t)/1000" if follow == "switched" else ""
    made = scene(f"sin(t**2){switch}", stop=abs(stop), moments=(1, 1, 1))
    more = {"state": "zyx"} if follow == "in angles" else {}
    propagator = symrot.propagator(made, method, 1e-15, **more)
    moved = propagator(np.linspace(0, stop, 41))
    truth = np.array([fresnel(t) for t in moved.t.tolist()])
    off = abs(moved.omega[:, 2] - truth) > 6e-15 * abs(truth).max()
    assert off.any() and len(moved.stats.rounded_beyond) == 1
    (beyond,) = moved.stats.rounded_beyond
    assert (abs(moved.t[off]) > abs(beyond)).all()
    cause = "the rounding of the torque, a formula that contains the time"
    cause = "rounding errors, in the steps of SciPy or in a formula" if method.startswith("scipy") else cause
    assert f"beyond t = {beyond!r} s {cause}" in moved.warnings[-1]
    if not more:
        assert propagator(moved.t, events=["omega_3 - 9"]).warnings == moved.warnings
    assert symrot.propagator(made, method, 1e-13, **more)(moved.t).warnings == ()


def test_the_samples_before_a_stop_carry_the_warning_too():
    with pytest.raises(PropagationError, match="rounding errors in a formula that contains the time") as stopped:
        symrot.propagator(scene("sin(t**2)", stop=60, moments=(1, 1, 1)), "taylor", 1e-15)(np.linspace(0, 60, 61))
    assert stopped.value.trajectory.warnings[-1].startswith("beyond t = ")


@pytest.mark.parametrize("torque", ["log(1 + t**2)*cos(t)", "tanh(100*(sin(t) - 1/2))", "1/(1 + (t**2 - 4)**2)"])
def test_rounding_of_a_phase_refuses_no_smooth_torque(torque):
    """The motion from rest is followed at the least tolerance, although its first rates are near zero."""
    made = scene(torque, stop=20.0, moments=(1, 1, 1))
    code = compile(torque, "torque", "eval")
    with mpmath.workdps(25):
        names = {"log": mpmath.log, "cos": mpmath.cos, "tanh": mpmath.tanh, "sin": mpmath.sin}
        impulse = float(
            mpmath.quad(lambda t: eval(code, names, {"t": t}), mpmath.linspace(0, 20, 81), method="gauss-legendre")
        )
    assert symrot.propagate(made.with_(tolerance=1e-15)).omega[-1, 2] == pytest.approx(impulse, rel=1e-14)


@pytest.mark.thinned(8)
@pytest.mark.parametrize("method", STEPPED)
@pytest.mark.parametrize(
    ("torque", "start", "c", "w", "stop", "tolerance"),
    [
        ("(1+tanh((t-c)/w))/2", 0.0, 1.0, 0.01, 4.0, 1e-12),  # the first scene of the report
        ("(1+tanh((t-c)/w))/2", 0.0, 1.0, 0.05, 10.0, 1e-12),
        ("(1+tanh((t-c)/w))/2", 0.0, 5.0, 0.1, 100.0, 1e-12),
        ("(1+tanh((t-c)/w))/2", 0.3, 1.0, 1e-5, 4.0, 1e-8),
        ("exp(-((t-c)/w)**2)", 0.0, 500.0, 30.0, 1000.0, 1e-10),
        ("exp(-((t-c)/w)**2)", 0.0, 50.0, 1.0, 100.0, 1e-12),
        ("exp(-((t-c)/w)**2)", 0.0, 2.0, 0.1, 10.0, 1e-12),
        ("exp(-((t-c)/w)**2)", 0.0, 2.0, 0.05, 10.0, 1e-12),
        ("exp(-((t-c)/w)**2)", 0.0, 2.0, 0.02, 10.0, 1e-12),
        ("exp(-((t-c)/w)**2)", 0.2, 7.0, 1e-4, 10.0, 1e-9),
        ("1/cosh((t-c)/w)**2", 0.0, 3.3, 0.003, 10.0, 1e-10),
        ("(t-c)/w*exp(-((t-c)/w)**2)", 0.0, 6.1, 0.01, 10.0, 1e-10),
        ("1/(1+((t-c)/w)**2)", 0.0, 2.0, 0.01, 10.0, 1e-12),
    ],
)
def test_the_momentum_is_the_impulse_of_a_torque_of_time(method, torque, start, c, w, stop, tolerance):
    """3 (omega_3 - start) is the integral of the torque, at samples and in dense output.

    The torque is scaled to an impulse of 3 N m s, since the tolerance is relative to this size.
    """
    impulse = IMPULSES[torque]
    grid = np.linspace(0, stop, 10001)
    size = max(1e-300, float(np.abs(impulse(np.append(grid, c), c, w)).max()))
    made = scene(f"m*({torque})", {"c": c, "w": w, "m": 3 / size}, (0, 0, start), stop)
    times = np.linspace(0, stop, 6)
    t, omega = rates(symrot.propagator(made, method, tolerance)(times), times)
    assert np.abs(omega - start - impulse(t, c, w) / size).max() < ALLOWED * tolerance * (1 + start)


def alone(made, method, stop):
    return symrot.propagator(made, method, 1e-12)([stop]).omega[0, 2]


def in_an_ensemble(made, method, stop):
    starts = [[0, 0, 0], [0, 0, 1]]
    return symrot.propagate_ensemble(made, omega=starts, t=[stop], method=method, tolerance=1e-12).omega[0, 0, 2]


def in_angles(made, method, stop):
    return symrot.propagator(made, method, 1e-12, state="zyx")([stop]).omega[0, 2]


@pytest.mark.parametrize("method", STEPPED)
def test_dense_output_reaches_the_last_sample(method):
    """It does although the end of the last step, a sum of two doubles, differs from the time of that sample."""
    made = symrot.Scene.from_dict({
        "schema": 1, "body": {"principal": [1, 1, 1]}, "initial": {"omega": [0, 0, 0]}, "span": {"t": ["-41.01", -40]},
        "torque": [{"kind": "expression", "torque": ["0", "0", "1000/cosh((t + 43.091)*1000)**2"]}],
    })  # fmt: skip
    trajectory = symrot.propagator(made, method, 1e-7)([-43.0943, 2.14])
    assert trajectory.sol(trajectory.t)[2] == pytest.approx(trajectory.omega[:, 2], abs=1e-9)


@pytest.mark.thinned(2)
@pytest.mark.parametrize("method", STEPPED)
@pytest.mark.parametrize("number", ["m", "1e11"])
@pytest.mark.parametrize("large", ["1 + tanh((t-2)*1000)", "tanh((t-2)*1000) - tanh((t-3)*1000)"])
def test_a_large_torque_that_is_zero_leaves_no_rounding(method, large, number):
    """Expanded, ``m + m*tanh(u) + ...`` would leave 1e-5 N m, the rounding error of m, from the start on."""
    small = "(1 + tanh((t-1/2)*10))/3"
    known = {"m": 10**11} if number == "m" else {}
    made = scene(f"{number}*({large}) - {small}", known, (0, 0, 0), 1.0, (1, 1, 1))
    truth = -IMPULSES["(1+tanh((t-c)/w))/2"](np.array([1.0]), 0.5, 0.1)[0] * 2 / 3
    assert abs(symrot.propagator(made, method, 1e-12)([1.0]).omega[0, 2] - truth) < ALLOWED * 1e-12


SCIPY = ("scipy:DOP853", "scipy:RK45", "scipy:Radau", "scipy:BDF", "scipy:LSODA")


@pytest.mark.thinned(6)
@pytest.mark.parametrize(
    ("method", "follow", "switch"),
    [
        *(
            pytest.param(method, alone, switch, marks=[pytest.mark.campaign] * (method == "scipy:Radau"))
            for method in ("taylor", "dop853", *SCIPY)
            for switch in ("", " + step(t - 1/4)/10")
        ),
        *((method, in_an_ensemble, "") for method in ("taylor", "dop853", "scipy:DOP853", "scipy:RK45", "scipy:LSODA")),
        *(
            pytest.param(method, in_an_ensemble, "", marks=pytest.mark.campaign)
            for method in ("scipy:Radau", "scipy:BDF")
        ),
        *((method, in_angles, "") for method in ("taylor", "dop853")),
    ],
)
def test_a_pulse_too_narrow_for_the_digits_of_the_time_keeps_its_impulse(method, follow, switch):
    """A microsecond wide at 2.1 s, where times rounded to 4e-16 s would lose 1e-9 of the impulse."""
    made = scene(f"1e6*exp(-((t - c)*1e6)**2){switch}", {"c": "21/10"}, (0, 0, 0), 3.0, (1, 1, 1))
    truth = sqrt(pi) + (2.75 / 10 if switch else 0)
    assert abs(follow(made, method, 3.0) - truth) < ALLOWED * 1e-12 * truth


@pytest.mark.parametrize("method", ["scipy:DOP853", "scipy:LSODA"])
def test_scipy_sees_the_pulse_too(method):
    t, omega = rates(
        symrot.propagator(scene("exp(-(t-50)**2)", None, (0, 0, 0), 100.0, (1, 1, 1)), method, 1e-8)([0.0, 100.0]),
        [0, 100],
    )
    assert np.abs(omega - sqrt(pi) / 2 * (erfs(t - 50) + 1)).max() < ALLOWED * 1e-8 * sqrt(pi)


@pytest.mark.parametrize("method", STEPPED)
def test_a_periodic_pulse_is_seen_every_time(method):
    """The integral of exp(k*(cos(t)-1)) is a series of Bessel functions."""
    k, stop = 200.0, 100.0
    t, omega = rates(
        symrot.propagator(scene("exp(k*(cos(t)-1))", {"k": k}, stop=stop), method, 1e-12)([0.0, stop]), [0, stop]
    )
    n = np.arange(1, 200)
    true = ive(0, k) * t + 2 * (ive(n, k) / n * np.sin(np.outer(t, n))).sum(axis=1)
    assert np.abs(omega - true / 3).max() < ALLOWED * 1e-12 * true.max() / 3 + 4 * 2**-52 * k


@pytest.fixture(scope="module")
def truths():
    """Return a dictionary for the references of this module, which both methods are compared with."""
    return {}


@pytest.mark.thinned(6)
@pytest.mark.parametrize("method", ["taylor", "dop853"])
@pytest.mark.parametrize("omega", [(0.01, 0.02, 0.03), (0.1, 0, 0.2)], ids=str)
@pytest.mark.parametrize(
    ("torque", "parameters", "features", "stop"),
    [
        ("m*(tanh((t-2)/w)-tanh((t-4)/w))/2", {"m": 0.05, "w": 0.05}, [(2.0, 0.05), (4.0, 0.05)], 100.0),
        ("(1+tanh((t-1)/w))/2", {"w": 0.02}, [(1.0, 0.02)], 10.0),
        ("exp(-((t-2)/w)**2)", {"w": 0.02}, [(2.0, 0.02)], 10.0),
        ("m*exp(k*(cos(t)-1))", {"m": 0.01, "k": 200.0}, [(0.0, 0.1)], 40.0),
    ],
)
def test_a_tumbling_body_meets_every_pulse(truths, method, omega, torque, parameters, features, stop):
    period = 2 * pi if "cos" in torque else 0.0
    told = [Feature(c, w, period=period) for c, w in features]
    problem = Problem((1, 2, 3), omega, (1, 0, 0, 0), 0.0, 0.0, stop, ("0", "0", torque), parameters, told, speed=1.0)
    truth = truths.get((torque, omega)) or truths.setdefault((torque, omega), reference(problem))
    trajectory = symrot.propagator(scene(torque, parameters, omega, stop), method, 1e-10)([0.0, stop / 2, stop])
    times = np.random.default_rng(3).uniform(0, stop, 50)
    true, states = truth.motion(times), trajectory.sol(times).T
    limit = ALLOWED * 1e-10
    assert np.abs(states[:, :3] - true[:, :3]).max() < limit * max(1, truth.growth[0]) * truth.omega_scale
    assert attitude_apart(states[:, 3:], true[:, 3:]).max() < limit * max(1, truth.growth[1])


@pytest.mark.thinned(4)
@pytest.mark.parametrize("method", STEPPED)
@pytest.mark.parametrize("w", [0.03, 0.003, 0.001, 0.0001])
def test_a_bump_of_the_angle_does_its_work(method, w):
    """C (omega^2 - 4)/2 is the work of m*exp(-((angle - c)/w)^2) at every angle below a full turn."""
    c, m = 1.3, 0.3 * 4 / w
    made = scene("m*exp(-((2*atan2(q3, q0)-c)/w)**2)", {"c": c, "w": w, "m": m}, (0, 0, 2), 1.4)
    times = np.random.default_rng(2).uniform(0, 1.4, 40)
    states = symrot.propagator(made, method, 1e-10)([0.0, 1.4]).sol(times)
    angle = 2 * np.arctan2(states[6], states[3])
    work = m * w * sqrt(pi) / 2 * (erfs((angle - c) / w) + erf(c / w))
    blurred = ALLOWED * 1e-10 * m / 2 / 3  # where the angle may be off by 20 tolerances, inside the bump
    inside = np.abs(angle - c) < 6 * w
    assert (np.abs(states[2] - np.sqrt(4 + 2 * work / 3)) < ALLOWED * 1e-10 * 2.4 + blurred * inside).all()
    assert (angle > 2 * c).any()


@pytest.mark.parametrize("method", STEPPED)
def test_a_soft_stop_sends_the_body_back(method):
    """A torque that depends on the angle alone stops the body and gives its rate back."""
    text = "-m*(1+tanh((2*atan2(q3, q0)-c)/w))/2"
    made = scene(text, {"c": 1.0, "w": 1e-3, "m": 400.0}, (0, 0, 2), 0.9)
    last = symrot.propagator(made, method, 1e-10)([0.0, 0.9])
    assert abs(last.omega[-1, 2] + 2) < ALLOWED * 1e-10 * 2
    assert 0 < 2 * np.arctan2(last.quaternion[-1, 3], last.quaternion[-1, 0]) < 0.9


@pytest.mark.parametrize("method", STEPPED)
def test_an_ensemble_meets_the_pulse(method):
    starts = [(0, 0, 0), (0, 0, 0.1), (0, 0, -3)]
    made = scene("m*exp(-((t-c)/w)**2)", {"c": 2.0, "w": 0.01, "m": 300.0}, stop=10.0)
    ensemble = symrot.propagate_ensemble(made, omega=starts, t=[0.0, 1.9, 10.0], method=method, tolerance=1e-10)
    assert ensemble.success
    assert np.abs(ensemble.omega[:, 2, 2] - np.array(starts)[:, 2] - sqrt(pi)).max() < ALLOWED * 1e-10 * 1.8


@pytest.mark.shipped_flags  # compiled quickly, it computes for a minute
@pytest.mark.thinned(8)
@pytest.mark.parametrize("method", ("taylor", "dop853"))
@pytest.mark.parametrize(
    "torque",
    ["exp(t**3)", pytest.param("exp(exp(t))", marks=pytest.mark.campaign), "cosh(100*t)", "1/(t-1/3)**3"],
)
def test_overflow_and_poles_end_in_a_sentence(torque, method):
    """Every method says how far it came, within the default limit of steps."""
    with pytest.raises(PropagationError, match=r"beyond t = [0-9.]+ s on the way to 20\.0 s"):
        symrot.propagator(scene(torque, stop=20.0), method, 1e-10)([20.0])


HIDDEN_SQUARE = "sqrt(t**2 - 2*({c})*t + ({c})**2)"
ROOTS_OF_SQUARES = [  # torque, and its integral over [0, 10] s
    ("((t-5)/sqrt((t-5)**2) - (t-5.01)/sqrt((t-5.01)**2))/2", 0.01),
    ("(1 - 2*(t-5)*(t-5.01)/sqrt(4*((t-5)*(t-5.01))**2))/2", 0.01),
    ("exp(-1000*sqrt((t-5.3)**2))", 0.002),
    ("(sqrt((t-5.3-0.001)**2) + sqrt((t-5.3+0.001)**2) - 2*sqrt((t-5.3)**2))/(2*0.001)", 0.001),
    (f"({HIDDEN_SQUARE.format(c='5.29')} + {HIDDEN_SQUARE.format(c='5.31')} - 2*{HIDDEN_SQUARE.format(c='5.3')})/0.02", 0.01),
    ("exp(-1000*sqrt((t-5.3)*(t-5.3)))", 0.002),
    ("exp(-1000*sqrt(sqrt((t-5.3)**4)))", 0.002),
    ("sqrt(1 - cos(t - 5.5))", 2 * sqrt(2) * (2 - cos(2.75) - cos(2.25))),
    ("sqrt(t)", 10**1.5 / 1.5),
]  # fmt: skip


@pytest.mark.thinned(12)
@pytest.mark.parametrize("method", ["auto", "dop853", "scipy:DOP853"])
@pytest.mark.parametrize("tolerance", [1e-6, 1e-10])
@pytest.mark.parametrize(("torque", "impulse"), ROOTS_OF_SQUARES)
def test_no_step_goes_past_the_bend_of_a_root(torque, impulse, tolerance, method):
    """sqrt(u^2) is abs(u), which bends at u = 0, however the square is written."""
    made = symrot.Scene.from_dict({
        "schema": 1, "body": {"principal": [1, 1, 1]}, "initial": {"omega": [0, 0, 1]}, "span": {"t": [0, 10]},
        "torque": [{"kind": "expression", "torque": ["0", "0", torque]}],
    })  # fmt: skip
    omega = symrot.propagator(made, method, tolerance)([0.0, 10.0]).omega[-1][2]
    assert abs(omega - 1 - impulse) < ALLOWED * tolerance


CONSTANTS = {
    "log(2)": log(2), "exp(1)": exp(1), "1/cosh(2)": 1 / cosh(2), "exp(-800)*exp(800)": 1.0, "sqrt(log(a))": sqrt(log(3)),
}  # fmt: skip


@pytest.mark.thinned(3)
@pytest.mark.parametrize("method", ["auto", "dop853", "scipy:DOP853"])
@pytest.mark.parametrize("constant", CONSTANTS)
def test_constants_of_torques_may_be_any_functions_of_numbers(constant, method):
    made = scene(f"{constant}*t", {"a": 3}, stop=2, moments=(1, 1, 1))
    assert symrot.propagate(made, method).omega[-1][2] == pytest.approx(2 * CONSTANTS[constant], rel=1e-11)


@pytest.mark.parametrize("constant", ["log(-2)", "acos(2)", "sqrt(-2)", "log(a - 4)", "asin(a)"])
def test_a_constant_without_a_real_value_is_refused(constant):
    with pytest.raises(symrot.InputError, match=r"torque: expected .* real values"):
        symrot.propagate(scene(f"{constant}*t", {"a": 3}))


SIZES_OF_SWITCHES = {  # torque, and its integral over [0, 6] s
    "sqrt(0.5 + abs(sign(sin(t))))": 6 * sqrt(1.5), "sqrt(abs(floor(sin(t))))": 6 - pi,
    "sqrt(0.5 + abs(where(sin(t) > 0, 1, -1)))": 6 * sqrt(1.5), "1/(1 + abs(sign(sin(t))))": 3.0,
    "log(1.5 + abs(sign(sin(t))))": 6 * log(2.5), "sqrt(1 + abs(where(sin(t) >= 0, -1/2, 3)))": pi * sqrt(1.5) + (6 - pi) * 2,
    "sqrt(2 + abs(where(sin(t) >= 0, -t/8, 4 + t)))": (2 + pi / 8) ** 1.5 * 16 / 3 - 2**1.5 * 16 / 3
    + (12**1.5 - (6 + pi) ** 1.5) / 1.5, "sqrt(0.5 + sign(sin(t)) - sign(2*sin(t)))": 6 * sqrt(0.5),
}  # fmt: skip


@pytest.mark.thinned(4)
@pytest.mark.parametrize("method", ["auto", "scipy:DOP853"])
@pytest.mark.parametrize("torque", SIZES_OF_SWITCHES)
def test_functions_of_what_jumps(torque, method):
    """Values that occur only between two switches at the same instant, such as sqrt(0.5 - 1), do no harm."""
    omega = symrot.propagator(scene(torque, stop=6, moments=(1, 1, 1)), method, 1e-10)([0.0, 6.0]).omega[-1][2]
    assert abs(omega - SIZES_OF_SWITCHES[torque]) < ALLOWED * 1e-10


@pytest.mark.parametrize("method", ["auto", "scipy:DOP853"])
def test_samples_before_a_torque_loses_its_value_are_kept(method):
    """log(-sign(t - 1)) is 0 before 1 s and has no value after that."""
    with pytest.raises(
        symrot.PropagationError, match=r"beyond t = 1\.0 s .* its rate of change is not finite there"
    ) as ended:
        symrot.propagator(scene("log(-sign(t - 1))", stop=2), method)([0.0, 0.5, 1.5])
    assert ended.value.trajectory.t.tolist() == [0.0, 0.5]


@pytest.mark.parametrize("method", ["auto", "dop853", "scipy:DOP853"])
def test_a_jump_in_the_last_bits_of_the_end_ends_the_motion(method):
    """mod(1e4 t, 1) jumps at 2 ms, and the double next to 2 ms is a little larger."""
    trajectory = symrot.propagator(scene("3*mod(1e4*t, 1)", stop=0.002), method, 1e-9)([0.0, 0.002])
    assert abs(trajectory.omega[-1][2] - 0.001) < ALLOWED * 1e-9


def test_the_bend_of_a_root_of_a_rate_is_not_passed_over():
    """omega_1 = t - 5; the integral of the hat of width 0.002 around omega_1 = 0.3 is 0.001."""
    hat = "(sqrt((omega_1-0.301)**2) + sqrt((omega_1-0.299)**2) - 2*sqrt((omega_1-0.3)**2))/0.002"
    made = symrot.Scene.from_dict({
        "schema": 1, "body": {"principal": [1, 1, 1]}, "initial": {"omega": [-5, 0, 1]}, "span": {"t": [0, 10]},
        "torque": [{"kind": "expression", "torque": ["1", "0", hat]}],
    })  # fmt: skip
    for method, tolerance in (("auto", 1e-10), ("dop853", 1e-6)):
        omega = symrot.propagator(made, method, tolerance)([0.0, 10.0]).omega[-1][2]
        assert abs(omega - 1.001) < ALLOWED * tolerance


@pytest.mark.thinned(4)
@pytest.mark.parametrize("method", STEPPED)
@pytest.mark.parametrize("torque", ["step(t-c)", "(1+sign(t-c))/2", "where(t < c, 0, 1)", "(1+(t-c)/abs(t-c))/2"])
def test_a_switch_is_located_to_the_last_bits(method, torque):
    """After the switch at c, omega_3 is (t - c)/3, to rounding of the tolerance 1e-12."""
    c = 1.2345678901234567
    times = [0.0, 4.0]
    t, omega = rates(symrot.propagator(scene(torque, {"c": c}), method, 1e-12)(times), times)
    assert np.abs(omega - np.maximum(t - c, 0) / 3).max() < ALLOWED * 1e-12


@pytest.mark.shipped_flags
@pytest.mark.parametrize("count", [100, pytest.param(1000, marks=pytest.mark.campaign)])
@pytest.mark.parametrize("method", STEPPED)
def test_a_thruster_fires_hundreds_of_times(method, count):
    """Pulses of 10 ms, one each second: the momentum is their number times m times 10 ms."""
    made = scene("where(mod(t, 1) < 0.01, m, 0)", {"m": 0.3}, stop=float(count))
    t, omega = rates(symrot.propagator(made, method, 1e-10)([0.0, float(count)]), [0, count])
    on = np.floor(t) * 0.01 + np.minimum(t - np.floor(t), 0.01)
    assert np.abs(omega - 0.1 * on).max() < ALLOWED * 1e-10


@pytest.mark.parametrize("method", STEPPED)
def test_dry_friction_stops_and_holds_the_body(method):
    """-sign(omega_3) stops a body with C = 3 and 1 rad/s after 3 s and 3/2 rad."""
    trajectory = symrot.propagator(scene("-sign(omega_3)", None, (0, 0, 1), 10.0), method, 1e-10)(
        np.linspace(0, 10, 11)
    )
    assert np.abs(trajectory.omega[:, 2] - np.maximum(1 - trajectory.t / 3, 0)).max() < ALLOWED * 1e-10
    angle = 2 * np.arctan2(trajectory.quaternion[-1, 3], trajectory.quaternion[-1, 0])
    assert abs(angle - 1.5) < ALLOWED * 1e-10


def test_a_motion_that_breaks_off_says_when():
    with pytest.raises(PropagationError, match=r"t = 0\.333"):
        symrot.propagator(scene("1/(t-1/3)", None, (0, 0, 1), 1.0), "dop853", 1e-8)([1.0])


def test_the_closed_forms_are_integrals_of_the_torques():
    """Each antiderivative of this file agrees with Gauss's rule on pieces one width long."""
    x, weights = np.polynomial.legendre.leggauss(30)
    c, w = 1.1, 0.07
    edges = np.arange(0, 3, w / 2)
    t = edges[:-1, None] + w / 4 * (x + 1)
    for torque, impulse in IMPULSES.items():
        values = eval(torque, {"t": t, "c": c, "w": w, "tanh": np.tanh, "exp": np.exp, "cosh": np.cosh})
        assert abs((values * weights).sum() * w / 4 - impulse(edges[-1], c, w)) < 1e-14, torque
    assert abs(log_cosh(3.0) - log(cosh(3.0))) < 1e-15


def test_a_bend_that_only_sympy_sees_is_refused():
    """exp(log(u^2)/2) is abs(u); no step may pass its bend unnoticed."""
    with pytest.raises(
        symrot.InputError, match=r"torque: expected every absolute value to be written with abs, .* write abs\(t - 5\)"
    ):
        symrot.propagate(scene("exp(-1000*exp(log((t - 5)**2)/2))", stop=10))
