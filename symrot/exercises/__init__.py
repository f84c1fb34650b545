"""Exercises with proven solutions: templates, random numbers, printed formats, and the grading of answers."""
