"""The lessons of all derivations."""

from symrot.lessons import (
    angular_velocity,
    attitude,
    bodies_under_torques,
    constraints,
    equations_of_motion,
    exact_motions,
    free_bodies,
    inertia,
)
from symrot.lessons.lesson import Lesson

__all__ = ["LESSONS"]

LESSONS: dict[str, Lesson] = {
    **attitude.LESSONS,
    **angular_velocity.LESSONS,
    **inertia.LESSONS,
    **equations_of_motion.LESSONS,
    **free_bodies.LESSONS,
    **bodies_under_torques.LESSONS,
    **exact_motions.LESSONS,
    **constraints.LESSONS,
}
"""Name of a derivation -> its lesson."""
