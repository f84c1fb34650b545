"""Lessons of the chapter on constraints."""

from symrot.lessons.lesson import Lesson, Mistake

LESSONS = {
    "rolling": Lesson(
        question="A ring, a disk and a ball roll down a slope. Which is fastest, and why?",
        before=("relative_motion", "kinetic_energy"),
        mistake=Mistake(
            "Friction does no work, so students omit it from the equation of motion.",
            "a == g*sin(alpha)",
            facts=("m*a == m*g*sin(alpha) - F", "F*R == C*a/R", "m > 0", "R > 0", "C > 0", "g > 0"),
            lesson="Friction does no work, but it slows the centre and makes the body rotate.",
        ),
        worked="acceleration_on_incline",
        topic="rolling",
    ),
    "gear_trains": Lesson(
        question="The sun of a planetary gear rotates. How fast does the carrier rotate?",
        before=("relative_motion",),
        mistake=Mistake(
            "The ring of a planetary gear is fixed. Students use the ratio of a simple pair of gears.",
            "omega_C == omega_S*Z_S/Z_R",
            facts=("Z_S*(omega_S - omega_C) == Z_R*omega_C", "Z_S > 0", "Z_R > 0"),
            lesson="The carrier moves, so the rates of the gears must be taken relative to the carrier.",
        ),
        worked="ring_fixed",
        topic="gears",
    ),
    "planar_linkages": Lesson(
        question="A crank rotates steadily. How does the piston move?",
        before=("relative_motion",),
        mistake=Mistake(
            "A long rod is nearly parallel to the line of the piston. Students neglect its inclination.",
            "r*cos(phi) + sqrt(L**2 - r**2*sin(phi)**2) == r*cos(phi) + L",
            facts=("L == r + d", "d > 0", "r > 0"),
            lesson="The two formulas agree at the dead centres, but not between them.",
        ),
        worked="piston_speed",
        topic="linkages",
    ),
}
