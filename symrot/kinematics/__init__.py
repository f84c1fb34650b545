"""Descriptions of attitude and their rates, derived with SymPy; ``conversions`` evaluates them with NumPy alone."""
