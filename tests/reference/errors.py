"""Print the errors of shipped scenes, divided by their tolerance: ``python -m tests.reference.errors``."""

from tests.propagation.test_propagator import (
    REFERENCE,
    TOLERANCES,
    attitude_error,
    propagate,
    propagator,
    rate_error,
    reference,
    symmetric_motion,
)

CLOSED = ("chen_cylinder", "axisymmetric_satellite", "axisymmetric_satellite_oblate")


def ratio(name: str, tolerance: float) -> float:
    """Return the larger of the errors of attitude and angular velocity, divided by the tolerance."""
    if name in CLOSED:
        trajectory = propagate(name, tolerance=tolerance)
        omega, dcm = symmetric_motion(trajectory.scene, trajectory.t)
    else:
        t, omega, dcm = reference(name)
        trajectory = propagator(name, tolerance=tolerance)(t)
    return max(rate_error(trajectory.omega, omega), attitude_error(trajectory.dcm, dcm)) / tolerance


def main() -> None:
    """Print the table."""
    print(f"{'error / tolerance at':30}" + "".join(f"{tolerance:>10.0e}" for tolerance in TOLERANCES))
    for name in (*CLOSED, *REFERENCE):
        print(f"{name:30}" + "".join(f"{ratio(name, tolerance):10.2g}" for tolerance in TOLERANCES))


if __name__ == "__main__":
    main()
