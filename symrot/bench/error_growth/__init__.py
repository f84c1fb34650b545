"""Growth of errors along a motion, near gimbal lock, and in the points of a body."""
