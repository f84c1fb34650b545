"""Motion in closed form of a free symmetric body with a rotor along its symmetry axis."""
