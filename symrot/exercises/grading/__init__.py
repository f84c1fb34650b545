"""The grading of answers: numbers with units, and formulas by the exact checker."""
