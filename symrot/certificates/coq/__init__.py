"""Theorems of Coq about the formulas of kernels."""
