"""Exercises with proven solutions: templates, random numbers, formats for classes, and the grading of answers."""
