"""Attitude descriptions and their rates, derived with SymPy; ``conversions`` is their numeric side, NumPy alone."""
