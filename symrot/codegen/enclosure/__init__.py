"""Enclosures of right-hand sides: bounds, in C, of the terms whose pulses (short changes) a step could miss."""
