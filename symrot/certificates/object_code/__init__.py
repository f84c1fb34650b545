"""Proofs that compiled object code performs the same roundings as the C text from which it was compiled."""
