"""Enclosures of right-hand sides: the terms that a step could miss, and C text that bounds them."""
