"""Enclosures of right-hand sides: bounds, and their C code, for terms in which a step could miss a pulse."""
