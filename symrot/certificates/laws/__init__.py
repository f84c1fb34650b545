"""Proofs that a kernel's formulas obey their laws (such as "the norm is 1") and that its C text computes them."""
