"""Motions: a plan with numbers and one initial state, from which the states at any time can be computed."""
