"""Formulas that have a name in books, derived by subject: moments of bodies, kinematics, mechanics."""
