"""Proofs that a kernel's formulas obey laws (such as "the norm is 1"), and that its C code computes the formulas."""
