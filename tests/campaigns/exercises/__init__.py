"""The campaign against the grading of exercises."""
