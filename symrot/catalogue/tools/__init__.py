"""Provide tools that several derivations use: elliptic functions, integrals, motions, power series, swept bodies."""
