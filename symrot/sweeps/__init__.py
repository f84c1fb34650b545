"""Sweeps: many motions of one scene by a design of varied values, in chunks that a store collects."""
