"""Scenes of these tests: a damped heavy top, and a sweep of it that takes little time."""

import symrot

DAMPED_TOP = {
    "schema": 1,
    "body": {"principal": [1, 1, "1/2"], "about": "fixed_point", "center_of_mass": [0, 0, "1/2"]},
    "initial": {"omega": ["1/10", "1/5", 20], "attitude": {"sequence": "ZXZ", "angles": [0, "1/2", 0]}},
    "torque": [{"kind": "gravity", "weight": 20}, {"kind": "damping", "linear": "1/100"}],
    "span": {"t": [0, 1], "samples": 3},
    "accuracy": {"tolerance": "1e-6"},
}
VARY = {"omega_1": "normal(0, 0.1)", "weight": "linspace(15, 25, 5)"}
OUTPUTS = ("omega_1", "axis_z@end", "energy@max")


def sweep(**options):
    """Return a sweep of 40 damped tops in this process; ``options`` change it."""
    chosen = {"vary": VARY, "attitudes": "uniform", "count": 40, "seed": 7, "outputs": OUTPUTS}
    chosen |= {} if "scheduler" in options else {"workers": 1}
    return symrot.sweep(DAMPED_TOP, **(chosen | options))
