"""A symmetric body under a constant torque about its axis."""
