"""From a scene to its plan: the equations that have to be integrated, and the kernels derived from them."""
