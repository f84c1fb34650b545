"""Random torques: symrot's motions compared with the truth."""
