"""A second way to the truth of a case: momentum, work and energy, or the reference repeated with other steps."""

from dataclasses import replace

import numpy as np

from tests.campaigns.torques.collocation import time_mesh
from tests.campaigns.torques.formulas import EXTENDED, STATES, names_of, torque_function
from tests.campaigns.torques.references import Problem, Truth, attitude_apart, reference

__all__ = ["contradiction", "impulse_of", "work_of"]

AGREE = 1e-14  # relative, above the rounding of the formula
NODES = 20


def impulse_of(problem: Problem, stop: float) -> "np.ndarray":
    """Return the integral of a torque of time from t0 to ``stop``, N m s, shape (3,), by Gauss's rule on a given mesh."""
    mesh = time_mesh(
        problem.t0, stop, problem.features, problem.breaks, min(problem.longest, (problem.high - problem.low) / 25)
    )
    return _integral(lambda t: torque_function(problem.texts, problem.parameters)(t, np.zeros((*t.shape, 7))), mesh)


def work_of(problem: Problem, angle: float) -> float:
    """Return the work, J, of a torque of the angle about axis 3, from angle 0, within a full turn."""
    features = [feature._replace(value=None, period=0.0) for feature in problem.features]
    torque = torque_function(problem.texts, problem.parameters)

    def of(x: "np.ndarray") -> "np.ndarray":
        y = np.zeros((*x.shape, 7), dtype=EXTENDED)
        y[..., 3], y[..., 6] = np.cos(x / 2), np.sin(x / 2)
        return torque(problem.t0, y)

    return float(_integral(of, time_mesh(0.0, angle, features, [], 0.5))[2]) if angle else 0.0


def _integral(function: "object", mesh: "np.ndarray") -> "np.ndarray":
    x, w = np.polynomial.legendre.leggauss(NODES)
    h = np.diff(mesh)
    t = mesh[:-1, None] + h[:, None] * ((x + 1) / 2).astype(EXTENDED)
    values = function(t)  # type: ignore[operator]
    return np.einsum("nk,nkc->c", h[:, None] * (w / 2).astype(EXTENDED), values)


def contradiction(problem: Problem, truth: Truth, again: bool = False) -> str:
    """Return a sentence that says how the truth breaks a law, or an empty result.

    With ``again`` the whole reference is repeated with other steps where no law is available.
    """
    high = min(problem.high, problem.reach)
    names = set().union(*map(names_of, problem.texts))
    moments = np.array(problem.principal)
    limit = AGREE * truth.omega_scale + truth.rounding[0]
    of_time = not names & set(STATES)
    one_axis = sum(bool(w) or text != "0" for w, text in zip(problem.omega, problem.texts, strict=True)) <= 1
    if of_time and (one_axis or len(set(problem.principal)) == 1):
        for stop in (high, problem.low):
            gain = truth.motion([stop])[0, :3] - np.array(problem.omega)
            apart = float(np.abs(gain - impulse_of(problem, stop) / moments).max()) if stop != problem.t0 else 0.0
            if apart > limit:
                return f"the momentum at t = {stop!r} s contradicts the impulse by {apart:.2g} rad/s"
    elif (
        names <= {"atan2", "q3", "q0", "exp", "tanh", "cosh", *problem.parameters}
        and problem.arcs is None
        and names & {"atan2"}
    ):
        states = truth.motion(np.linspace(problem.t0, high, 8)[1:])
        turned = 2 * np.arctan2(states[:, 6], states[:, 3])
        if truth.turned < 6:
            for rate, angle in zip(states[:, 2], turned, strict=True):
                energy = (rate**2 - EXTENDED(problem.omega[2]) ** 2) / 2 * moments[2]
                apart = float(abs(energy - work_of(problem, float(angle)))) / moments[2] / truth.omega_scale
                if apart > limit + 1e-15 * truth.omega_scale:
                    return f"the energy at {float(angle)!r} rad contradicts the work by {apart:.2g} rad/s"
    elif again and problem.arcs is None:
        other = reference(replace(problem, longest=min(problem.longest, (high - problem.low) / 37)))
        times = np.linspace(problem.low, high, 23)
        one, two = truth.motion(times), other.motion(times)
        apart, turn = float(np.abs(one[:, :3] - two[:, :3]).max()), float(attitude_apart(one[:, 3:], two[:, 3:]).max())
        grown = [max(1.0, g) for g in truth.growth]
        if apart > limit * grown[0] or turn > 1e-14 * grown[1] + truth.rounding[1]:
            return f"another choice of steps moves the reference by {apart:.2g} rad/s and {turn:.2g} rad"
    return ""
