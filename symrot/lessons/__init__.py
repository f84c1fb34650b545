"""Lessons: what a page of a derivation has for students beside its steps."""
