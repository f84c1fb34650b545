"""Equations of motion of a rigid body, the torques on it, and its conserved quantities, derived with SymPy."""
