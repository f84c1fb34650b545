"""Certificates: statements about emitted C kernels (formulas, rounding errors) with their proofs, and their checkers."""
