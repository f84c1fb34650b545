"""The diagnosis of a false claim, and the nearest true formulas."""
