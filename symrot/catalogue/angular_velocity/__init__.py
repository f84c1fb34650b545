"""Angular velocity: its tensor, and the rates of angles, quaternions, rotation vectors and Rodrigues parameters."""
