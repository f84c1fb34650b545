"""Motions in closed form: the angular velocity and attitude at any time, without numerical integration."""
