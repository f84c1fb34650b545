"""Proven upper limits of the step length: no step passes over a short pulse of a torque formula.

They follow from bounds of the formulas on discs of complex numbers (enclosures).
"""
