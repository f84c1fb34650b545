"""Proofs of the laws of a kernel, and of the equality of its C text with its formulas."""
