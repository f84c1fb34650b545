"""How far a step may go: the discs on which a torque's formula is enclosed."""
