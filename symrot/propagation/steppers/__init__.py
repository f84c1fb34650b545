"""The steppers: Taylor series and DOP853 in C, and SciPy's methods."""
