"""Proofs that compiled object code performs the same roundings as the C text it was compiled from."""
