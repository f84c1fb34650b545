"""Random torques against the truth."""
