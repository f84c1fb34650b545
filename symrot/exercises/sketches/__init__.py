"""Sketches of exercises, drawn with the lines and arrows of :mod:`symrot.figures.picture`."""
