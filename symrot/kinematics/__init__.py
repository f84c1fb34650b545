"""Descriptions of attitude and their rates, derived with SymPy; ``conversions`` computes them with NumPy alone."""
