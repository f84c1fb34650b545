"""How errors grow along a motion, at gimbal lock, and in the points of a body."""
