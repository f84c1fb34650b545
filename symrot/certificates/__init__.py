"""Certificates: statements about emitted C kernels (formulas, rounding errors) with proofs, and their checkers."""
