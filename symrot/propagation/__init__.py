"""Steppers of a motion: DOP853 in C around an emitted kernel, and SciPy where there is no compiler."""
