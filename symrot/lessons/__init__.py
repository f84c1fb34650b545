"""Lessons: question, numbers, a common mistake and links for students, added to the pages of derivations."""
