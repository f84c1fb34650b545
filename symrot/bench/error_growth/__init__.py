"""Growth of errors along a motion, near gimbal lock, and in the positions of a body's points."""
