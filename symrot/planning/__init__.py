"""Plans: the least set of equations for a scene, and the saved kernels derived from it."""
