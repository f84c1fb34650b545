"""From proven formulas to kernels: lowering, printing as C and NumPy, building and loading."""
