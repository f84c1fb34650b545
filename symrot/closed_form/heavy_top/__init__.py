"""Motion in closed form of the symmetric heavy top (Lagrange's top) and of pendulums."""
