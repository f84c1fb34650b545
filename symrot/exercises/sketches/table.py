"""The sketch of each template of exercises: an SVG drawing with a title for screen readers.

A sketch shows the arrangement and the letters of an exercise, not its numbers.
"""

from collections.abc import Callable

from symrot.exercises.sketches import attitude, bodies, inertia, mechanisms, tops

__all__ = ["SKETCHES", "sketch"]

SKETCHES: dict[str, Callable[..., str]] = {
    "period_of_rod": inertia.hanging_rod,
    **dict.fromkeys(("falling_rod", "start_of_fall"), inertia.level_rod),
    **dict.fromkeys(("rod_about_end", "radius_of_gyration"), inertia.rod_about_end),
    "rod_about_point": inertia.rod_beside_centre,
    **dict.fromkeys(("hollow_cylinder", "drilled_disk"), inertia.ring_with_two_radii),
    "box_about_axis": inertia.box_with_axis,
    "box_about_edge": inertia.crate_on_edge,
    **dict.fromkeys(("disk_about_rim", "period_of_disk"), inertia.disk_on_nail),
    "cone_about_apex": inertia.cone_on_apex,
    "rod_with_ball": inertia.rod_with_ball,
    "product_of_triangle": inertia.set_square,
    "product_of_two_masses": inertia.two_masses,
    "thrown_book": inertia.book,
    **dict.fromkeys((
        "body_rates", "space_rates", "angle_rates_from_omega", "matrix_entry", "speed_of_rotation",
        "vertical_in_body",
    ), attitude.euler_angles),
    **dict.fromkeys(("determinant", "angle_of_lock"), attitude.gimbal),
    "growth_near_lock": attitude.gimbal_near_lock,
    "only_sum_of_angles": attitude.locked_gimbal,
    "point_turned_twice": attitude.turned_twice,
    "angle_of_two_rotations": attitude.two_steps,
    "order_matters": attitude.pointer_in_two_orders,
    "relative_rotation": attitude.two_cameras,
    **dict.fromkeys(("rotation_in_steps", "twice_the_angle"), attitude.same_axis),
    "component_of_rotation": attitude.turned_once,
    "rotated_vector": attitude.rotated_axis,
    "rate_of_component": attitude.rate_in_body_axes,
    "angle_between": attitude.two_attitudes,
    "solid_about_axis": bodies.solid_with_axis,
    "principal_moment": bodies.plate_in_other_axes,
    **dict.fromkeys((
        "free_acceleration", "driven_acceleration", "torque_to_keep", "kinetic_energy", "angular_momentum",
        "power_of_torque",
    ), bodies.box_with_rate),
    "disk_wobble": bodies.wobbling_disk,
    "rod_like_precession": bodies.wobbling_pencil,
    "wobble_period": bodies.cones_of_flat_body,
    **dict.fromkeys((
        "separatrix_momentum", "polhode_constants", "growth_rate", "swing_about_largest", "swing_about_smallest",
    ), bodies.polhodes),
    **dict.fromkeys((
        "spin_for_precession", "slowest_spin", "momentum_about_vertical", "energy_of_top", "slow_precession",
        "space_direction_of_axis", "rate_about_vertical",
    ), tops.tilted_top),
    "level_precession": tops.level_top,
    "sleeping_top": tops.upright_top,
    "wheel_on_cord": tops.wheel_on_cord,
    **dict.fromkeys(("bearing_torque", "bearing_forces"), tops.rotor_in_bearings),
    "unbalanced_shaft": tops.unbalanced_rotor,
    "reaction_wheel": tops.satellite_with_wheel,
    "tilted_wheel": tops.person_on_turntable,
    **dict.fromkeys((
        "body_precession", "space_precession", "body_cone", "angle_of_momentum",
    ), tops.axis_omega_momentum),
    **dict.fromkeys((
        "rotated_point", "trace_of_rotation", "matrix_of_axis_angle", "rodrigues_parameter",
    ), tops.rotation_about_axis),
    **dict.fromkeys(("struck_rod", "struck_place", "energy_of_blow", "resting_point"), mechanisms.struck_rod),
    "bullet_and_rod": mechanisms.bullet_and_rod,
    "percussion_of_racket": mechanisms.bat,
    **dict.fromkeys(("acceleration_on_incline", "least_friction", "speed_at_bottom"), mechanisms.roller_on_incline),
    **dict.fromkeys(("share_of_rotation", "top_of_wheel"), mechanisms.rolling_wheel),
    "cue_height": mechanisms.ball_and_cue,
    **dict.fromkeys((
        "ring_fixed", "sun_fixed", "carrier_fixed", "both_driven", "planet_rate", "torque_of_carrier",
    ), mechanisms.planetary_gear),
    **dict.fromkeys((
        "piston_speed", "acceleration_at_dead_centre", "rod_rate", "crank_torque",
    ), mechanisms.crank_and_slider),
    "scotch_yoke": mechanisms.scotch_yoke,
    "ladder": mechanisms.ladder,
}  # fmt: skip
"""Name of a template -> the function that draws its sketch; a template that is not here has none."""


def sketch(template: str, *arguments: str) -> str:
    """Return the sketch of a template as SVG, or an empty text if it has none.

    ``arguments`` are those of the drawing, such as the sequence of the Euler angles, ``"ZXZ"``.
    """
    return SKETCHES[template](*arguments) if template in SKETCHES else ""
