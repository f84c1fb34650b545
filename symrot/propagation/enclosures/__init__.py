"""Proven limits of steps: bounds of the torque formulas on discs of the complex plane (enclosures)."""
