"""Motion of a free rigid body in closed form, by elliptic functions."""
