"""A free symmetric body with a rotor along its axis."""
