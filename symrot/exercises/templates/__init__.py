"""The table of templates by topic. A template is a function from a random number generator to a problem.

The name of a template is the name of its function. A module is imported when one of its templates is used.
"""

from importlib import import_module

from symrot.errors import InputError, with_hint
from symrot.exercises.problem import Template

__all__ = ["TOPICS", "chosen", "template", "topic_of"]

TOPICS: dict[str, tuple[str, ...]] = {
    "inertia": (
        "rod_about_end",
        "rod_about_point",
        "solid_about_axis",
        "hollow_cylinder",
        "box_about_axis",
        "box_about_edge",
        "disk_about_rim",
        "cone_about_apex",
        "rod_with_ball",
        "drilled_disk",
        "product_of_triangle",
        "product_of_two_masses",
        "principal_moment",
        "radius_of_gyration",
    ),
    "euler_angles": (
        "body_rates",
        "space_rates",
        "angle_rates_from_omega",
        "matrix_entry",
        "space_direction_of_axis",
        "speed_of_rotation",
        "vertical_in_body",
        "rate_about_vertical",
    ),
    "singularities": ("determinant", "growth_near_lock", "only_sum_of_angles", "angle_of_lock"),
    "composition": (
        "point_turned_twice",
        "angle_of_two_rotations",
        "order_matters",
        "relative_rotation",
        "rotation_in_steps",
    ),
    "axis_and_angle": ("rotated_point", "trace_of_rotation", "matrix_of_axis_angle", "rodrigues_parameter"),
    "quaternions": (
        "product",
        "norm_of_product",
        "component_of_rotation",
        "rotated_vector",
        "rate_of_component",
        "angle_between",
        "twice_the_angle",
    ),
    "euler_equations": (
        "free_acceleration",
        "driven_acceleration",
        "torque_to_keep",
        "kinetic_energy",
        "angular_momentum",
        "unbalanced_shaft",
        "power_of_torque",
    ),
    "free_bodies": (
        "body_precession",
        "space_precession",
        "body_cone",
        "angle_of_momentum",
        "disk_wobble",
        "rod_like_precession",
        "separatrix_momentum",
        "polhode_constants",
        "wobble_period",
    ),
    "stability": ("growth_rate", "swing_about_largest", "swing_about_smallest", "thrown_book"),
    "heavy_tops": (
        "spin_for_precession",
        "level_precession",
        "slowest_spin",
        "sleeping_top",
        "momentum_about_vertical",
        "energy_of_top",
        "slow_precession",
    ),
    "gyroscopes": ("wheel_on_cord", "bearing_torque", "bearing_forces", "reaction_wheel", "tilted_wheel"),
    "impulse": (
        "struck_rod",
        "struck_place",
        "energy_of_blow",
        "resting_point",
        "bullet_and_rod",
        "percussion_of_racket",
    ),
    "rolling": (
        "acceleration_on_incline",
        "least_friction",
        "speed_at_bottom",
        "share_of_rotation",
        "cue_height",
        "top_of_wheel",
    ),
    "gears": ("ring_fixed", "sun_fixed", "carrier_fixed", "both_driven", "planet_rate", "torque_of_carrier"),
    "linkages": ("piston_speed", "acceleration_at_dead_centre", "rod_rate", "crank_torque", "scotch_yoke", "ladder"),
    "pendulums": ("period_of_rod", "period_of_disk", "falling_rod", "start_of_fall"),
}
"""Topic, which is the name of a module -> the names of its templates."""


def template(name: str) -> Template:
    """Return the template with a given name, a function from a random number generator to a problem."""
    made: Template = getattr(import_module(f"{__name__}.{topic_of(name)}"), name)
    return made


def topic_of(name: str) -> str:
    """Return the topic (module name) that contains a given template."""
    return next(topic for topic, names in TOPICS.items() if name in names)


def chosen(topic: str) -> tuple[str, ...]:
    """Return the names of templates: all templates of a topic, or one template by its name.

    Raises
    ------
    InputError
        For a text that names neither a topic nor a template.
    """
    if topic in TOPICS:
        return TOPICS[topic]
    if any(topic in names for names in TOPICS.values()):
        return (topic,)
    message = (
        f"exercise: expected a topic, one of {', '.join(TOPICS)}, or a template that `symrot exercise --list` names, "
        f"got {topic!r}"
    )
    raise InputError(with_hint(message, topic, [*TOPICS, *(name for names in TOPICS.values() for name in names)]))
