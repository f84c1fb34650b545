"""Motion in closed form of a symmetric body under a constant torque about its axis."""
