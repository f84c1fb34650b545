"""Find what is wrong with a false claim, and the nearest formulas that are true."""
