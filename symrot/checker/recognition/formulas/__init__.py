"""Formulas that books name, derived by subject: moments of bodies, kinematics, mechanics."""
