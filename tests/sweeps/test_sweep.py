"""Sweeps: each trajectory is that of its own scene; chunks and workers change no bit; failures keep their rows."""

import numpy as np
import pytest

import symrot
from symrot.errors import InputError
from tests.needs import needs_compiler
from tests.sweeps.scenes import DAMPED_TOP, OUTPUTS, sweep

xarray = pytest.importorskip("xarray")


@pytest.fixture(scope="module")
def whole():
    return sweep().to_xarray().load()


@pytest.mark.parametrize("chunk", [1, 7])
def test_any_chunks_give_the_same_bits(whole, chunk):
    xarray.testing.assert_identical(sweep(chunk=chunk).to_xarray(), whole)


def test_a_trajectory_is_the_motion_of_its_own_scene(whole):
    for k in (0, 13, 39):
        row = whole.isel(trajectory=k)
        scene = DAMPED_TOP | {
            "initial": {
                "omega": [float(row.input_omega_1), "1/5", 20],
                "attitude": {"quaternion": row.input_quaternion.values.tolist()},
            },
            "torque": [{"kind": "gravity", "weight": float(row.input_weight)}, DAMPED_TOP["torque"][1]],
        }
        motion = symrot.propagator(symrot.Scene.from_dict(scene), "dop853", 1e-12)(row.time.values)
        for name, values in (
            ("omega_1", motion.omega[:, 0]), ("axis_z@end", motion.axis[-1, 2]), ("energy@max", motion.energy.max())
        ):  # fmt: skip
            assert np.abs(row[name] - values).max() < 1e-5 * max(1, np.abs(values).max())  # tolerance 1e-6 of the sweep


def test_outputs_have_units_frames_and_meanings(whole):
    assert whole.omega_1.attrs == {
        "units": "rad/s", "frame": "body", "long_name": "omega_1", "description": "angular velocity, body components"
    }  # fmt: skip
    assert whole["energy@max"].attrs["units"] == "J" and whole.input_weight.attrs["units"] == "N"
    assert whole["axis_z@end"].attrs["description"].endswith("at t = 1.0 s")


def test_outputs_at_one_time_need_no_other_samples(whole):
    ends = sweep(outputs=["axis_z@end", "omega_1@0.5"]).to_xarray()
    assert np.allclose(ends["axis_z@end"], whole["axis_z@end"], rtol=0, atol=1e-13)
    assert np.allclose(ends["omega_1@0.5"], whole.omega_1[:, 1], rtol=0, atol=1e-13)


def test_a_mass_changes_inertia_and_weight():
    """Torque and inertia are proportional to the mass, so that the motion of a heavy top does not depend on it."""
    result = symrot.sweep(
        "heavy_top_loops", {"body.mass": [0.25, 0.5, 1.0]}, outputs=["axis_x@end", "energy@end"], workers=1
    ).to_xarray()
    assert np.ptp(result["axis_x@end"].values) < 1e-9
    assert np.allclose(result["energy@end"] / result["input_body.mass"], result["energy@end"][1] / 0.5, rtol=1e-12)


def test_a_number_has_the_short_names_of_scenes():
    """``linear``, one number in the file for three constants, and ``mass``."""
    for scene, name, path in ((DAMPED_TOP, "linear", "torque[1].linear"), ("heavy_top_loops", "mass", "body.mass")):
        results = [
            symrot.sweep(scene, {key: [0.02, 0.05]}, outputs="omega_1@end", t=[0, 0.2], workers=1)
            for key in (name, path)
        ]
        assert np.array_equal(*(result.array("omega_1@end") for result in results))
    with pytest.raises(InputError, match="expected a value that can vary"):
        symrot.sweep(DAMPED_TOP, {"samples": [3, 4]})


def test_a_number_in_the_scene_file_gives_the_motion_of_that_file():
    result = symrot.sweep(
        DAMPED_TOP,
        {"initial.attitude.angles[1]": [0.5, 1.0], "torque[1].linear": [0.25, 0.5], "body.principal[2]": [0.75]},
        outputs="omega_1@end", workers=1, tolerance=1e-10,
    ).to_xarray()  # fmt: skip
    for k, (angle, linear) in enumerate([(0.5, 0.25), (0.5, 0.5), (1.0, 0.25), (1.0, 0.5)]):
        scene = DAMPED_TOP | {
            "body": DAMPED_TOP["body"] | {"principal": [1, 1, 0.75]},
            "initial": DAMPED_TOP["initial"] | {"attitude": {"sequence": "ZXZ", "angles": [0, angle, 0]}},
            "torque": [DAMPED_TOP["torque"][0], {"kind": "damping", "linear": linear}],
        }
        motion = symrot.propagator(symrot.Scene.from_dict(scene), "dop853", 1e-12)([0.0, 1.0])
        assert abs(result["omega_1@end"][k] - motion.omega[-1, 0]) < 1e-8


@pytest.mark.parametrize(
    ("vary", "reason"),
    [
        ({"I_xx": [0.3, 1.0, 2.0, 1.1]}, "moments of inertia none of which exceeds the sum of the other two"),
        ({"body.principal[0]": [0.3, 1.0, 2.0, 1.1]}, "moments of inertia none of which exceeds the sum"),
        ({"weight": [-1.0, 1.0, 0.0, 2.0]}, "expected positive values in N"),
    ],
)
def test_a_trajectory_without_a_body_keeps_its_row_and_its_reason(vary, reason):
    result = symrot.sweep(DAMPED_TOP, vary, outputs=["omega_1", "omega_3@end"], workers=1)
    data = result.to_xarray()
    assert result.impossible == 2 and data.status.values.tolist() == [-2, 0, -2, 0]
    assert np.isnan(data.omega_1[::2]).all() and not np.isnan(data.omega_1[1::2]).any()
    assert reason in str(data.message.values[0]) and data.message.values[1] == ""
    assert [row for row, _ in result.reasons] == [0, 2] and "trajectory 0" not in result.reasons[1][1]
    alone = symrot.sweep(DAMPED_TOP, {next(iter(vary)): [1.0]}, outputs="omega_1", workers=1).to_xarray()
    if 1.0 in next(iter(vary.values())):
        assert np.array_equal(data.omega_1[1], alone.omega_1[0])


def test_a_trajectory_whose_accuracy_is_in_doubt_says_so_in_its_message():
    torque = [{"kind": "expression", "torque": ["0", "0", "k*sin(t**2)"], "parameters": {"k": 1}}]
    made = {"schema": 1, "body": {"principal": [1, 1, 1]}, "torque": torque, "initial": {"omega": [0, 0, 0]}}
    made["span"] = {"t": [0, 9], "samples": 2}
    options = {"t": [0, 9], "outputs": "omega_3@end", "tolerance": 1e-15, "workers": 1}
    result = symrot.sweep(made, {"k": [0.0, 1.0]}, **options)
    assert result.stopped == result.impossible == 0
    quiet, text = result.array("message")
    assert quiet == "" and text.startswith("warning: beyond t = ")
    expected = "1 of 2 trajectories have a warning, for example trajectory 1: " + text.removeprefix("warning: ")
    assert result.warnings == (expected,)


@pytest.mark.filterwarnings("error")
def test_a_trajectory_whose_output_overflows_has_no_value():
    """An infinite energy made percentiles NaN and lost the sweep in a histogram."""
    options = {"outputs": ["energy@end", "omega_3@end"], "statistics": ["mean", "histogram(2)"]}
    result = symrot.sweep("damped_disk", {"omega_3": [1e160, 1.0]}, workers=1, **options)
    assert result.array("status").tolist() == [-2, 0] and np.isnan(result.array("omega_3@end")[0])
    assert result.reasons == [(0, "energy@end: expected a value within the range of doubles, got infinity")]
    assert result.array("energy@end_number") == 1


def test_a_scene_with_samples_is_refused_before_the_sweep():
    """Every trajectory was written as one that no motion can have."""
    with pytest.raises(InputError, match="got a torque of kind table"):
        symrot.sweep("thruster_pulse", {"omega_1": [0.0, 1.0]}, workers=1)


def test_zeros_and_equal_moments_in_other_rows_change_no_bit():
    """The equations of a row are chosen by its own constants, also where a chunk holds rows of other kinds."""
    vary = {"linear_3": [0.0, 0.1], "I_xx": [1.0, 1.1]}
    together, alone = (
        symrot.sweep(DAMPED_TOP, vary, outputs=["omega", "quaternion"], workers=1, chunk=chunk).to_xarray()
        for chunk in (4, 1)
    )
    xarray.testing.assert_identical(together, alone)


def test_statistics_are_those_of_all_values(whole):
    result = sweep(statistics=["percentiles(5, 50, 95)", "envelope"], chunk=9).to_xarray()
    for name in OUTPUTS:
        assert np.array_equal(result[f"{name}_percentile"], np.percentile(whole[name], [5, 50, 95], axis=0))
        assert np.array_equal(result[f"{name}_max"], whole[name].max(axis=0))
    only = sweep(statistics="envelope", keep="statistics").to_xarray()
    assert "omega_1" not in only and np.array_equal(only.omega_1_min, result.omega_1_min)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"outputs": "omga_1@end"}, "output: expected one of omega, .*did you mean 'omega_1'?"),
        ({"outputs": "omega_1@ned"}, "did you mean 'end'?"),
        ({"outputs": "omega_1@7"}, "expected a time from 0.0 to 1.0 s after @"),
        ({"outputs": ["omega", "omega_1"]}, "got omega_1 a second time"),
        ({"outputs": []}, "at least one output"),
        ({"outputs": ["euler_ZXZ_1", "euler_ZYX_1"]}, "one sequence"),
        ({"outputs": "euler"}, "output: expected one of"),
        ({"method": "tayler"}, "method: expected one of"),
        ({"tolerance": 2}, "tolerance: expected a number"),
        ({"workers": 0}, "workers: expected a whole number"),
        ({"chunk": 0}, "chunk: expected a whole number"),
        ({"keep": "statistics"}, "keep: expected statistics"),
        ({"keep": "some"}, "keep: expected one of"),
        ({"t": [[0.0]]}, "t: expected times"),
        ({"path": "a.csv"}, "ends in .zarr, .parquet"),
        ({"path": "nowhere/a.zarr"}, "existing folder"),
        ({"count": 1e9}, "path: expected a file to write"),
        ({"vary": [1]}, "vary: expected a dict"),
        ({"vary": {3: "normal(0, 1)"}}, "vary: expected the name of a value, such as 'omega_1', got 3"),
        ({"outputs": 3}, "outputs: expected a string or a list of strings, got 3"),
        ({"outputs": [3]}, "output: expected a text such as 'omega_1@end', got 3"),
        ({"statistics": 3}, "statistics: expected a string or a list of strings, got 3"),
    ],
)
def test_an_argument_that_cannot_be_used_is_one_sentence(options, message):
    with pytest.raises(InputError) as error:
        sweep(**options)
    assert "\n" not in str(error.value)
    for part in message.split(".*"):
        assert part in str(error.value)


@needs_compiler
def test_outputs_that_are_derivatives_are_those_of_an_ensemble():
    """For any chunks; the mass varies with the constants that follow from it, and the variable is one of them."""
    names = ["omega_1_by_omega_3@end", "rotation_by_weight"]
    options = {"count": 4, "seed": 3, "t": [0, 0.1], "workers": 1, "outputs": names}
    vary = {"omega_1": "normal(0, 0.1)", "body.mass": "linspace(0.4, 0.6, 2)"}
    result = symrot.sweep("heavy_top_loops", vary, **options)
    masses = result.array("input_body.mass")
    scene = symrot.load_scene("heavy_top_loops").with_({"body.mass": masses[1]})
    omega = [[result.array("input_omega_1")[1], *map(float, scene.initial.omega_b[1:])]]
    alone = symrot.propagate_ensemble(scene, omega=omega, t=[0, 0.1], sensitivities=["omega_3", "weight"])
    assert abs(result.array("omega_1_by_omega_3@end")[1] - alone.sensitivities["omega_3"].omega[0, 1, 0]) < 1e-14
    own = [result.array(f"rotation_{i}_by_weight")[1] for i in (1, 2, 3)]
    assert np.abs(np.transpose(own) - alone.sensitivities["weight"].rotation[0]).max() < 1e-14
    other = symrot.sweep("heavy_top_loops", vary, chunk=1, **options)
    assert np.array_equal(other.array("rotation_2_by_weight"), result.array("rotation_2_by_weight"))
    assert result.to_xarray().rotation_2_by_weight.units == "(rad)/(N)"


@pytest.mark.parametrize(
    ("scene", "output", "message"),
    [
        ("heavy_top_loops", "omega_1_by_wieght", "did you mean 'weight'"),
        ("heavy_top_loops", "omeg_1_by_weight", "did you mean 'omega_1'"),
        ("heavy_top_loops", "omega_1_by_body.mass@end", "body.mass changes I_xx"),
    ],
)
def test_a_derivative_that_does_not_exist_is_refused_before_the_sweep(scene, output, message):
    vary = {"omega_1": "normal(0, 1)"} | ({"body.mass": [0.4, 0.6]} if scene == "heavy_top_loops" else {})
    with pytest.raises(InputError, match=message):
        symrot.sweep(scene, vary, count=2, outputs=output)


def test_drawn_attitudes_keep_an_angular_velocity_given_in_space():
    scene = {
        "schema": 1, "body": {"principal": [1, 2, "5/2"]}, "span": {"t": [0, 1]},
        "initial": {"omega_space": ["3/10", "7/10", "11/10"], "attitude": {"axis": [1, 2, 3], "angle": 1}},
    }  # fmt: skip
    more = {"attitudes": "uniform", "outputs": "omega_space@start", "workers": 1}
    fixed = symrot.sweep(scene, count=4, **more)
    varied = symrot.sweep(scene, {"initial.omega_space[0]": [1, 2]}, count=4, **more)
    for result, first in ((fixed, np.full(4, 0.3)), (varied, np.array([1.0, 2.0, 1.0, 2.0]))):
        rates = np.stack([result.array(f"omega_{axis}@start") for axis in "xyz"], axis=1)
        assert np.abs(rates - np.stack([first, np.full(4, 0.7), np.full(4, 1.1)], axis=1)).max() < 1e-14


def test_times_in_another_order_than_that_of_the_results_are_refused():
    with pytest.raises(InputError, match="t: expected sample times in increasing order"):
        sweep(t=[1, 0.5])


@pytest.mark.parametrize(("output", "statistic"), [
    ("euler_ZYX_1@end", "mean"), ("q0", "percentiles(50)"), ("euler_ZYX_1@mean", "envelope"),
])  # fmt: skip
def test_angles_and_quaternions_have_no_mean(output, statistic):
    """Of two tops at 174 and -174 degrees, the mean angle was 0."""
    with pytest.raises(InputError, match=r"angles jump by 360 degrees|q and -q are one attitude"):
        sweep(outputs=[output], statistics=statistic)


def test_a_sweep_prints_as_one_line():
    assert repr(sweep()) == "<Sweep of scene: 40 trajectories, in memory>"
    result = symrot.sweep("heavy_top_loops", {"body.mass": [0.5, -0.5]}, outputs="omega_3@end")
    assert repr(result) == "<Sweep of heavy_top_loops: 2 trajectories, 1 impossible, in memory>"
