"""Plans: the smallest set of equations for each scene, and the saved kernels that are derived from it."""
