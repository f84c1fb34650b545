"""Enclosures of right-hand sides: terms with features that a step could miss, such as pulses, and C code of bounds."""
