"""Proven limits of steps: enclosures of the formulas of torques on discs of the complex plane."""
