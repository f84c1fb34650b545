"""Limits of the effort for one decision, counted in operations and conversions, and the size of formulas."""
