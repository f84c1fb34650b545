"""Proven upper limits of the step length, so that no step passes over a short pulse of a torque formula."""
