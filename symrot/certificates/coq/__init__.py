"""Theorems about the formulas of kernels, for the proof assistant Coq."""
