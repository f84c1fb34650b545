"""Enclosures of right-hand sides: the terms with features that a step could miss, and C text that bounds them."""
