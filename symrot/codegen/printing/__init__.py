"""Print programs as C and NumPy."""
