"""Tools that several derivations share: elliptic functions, integrals, motions, power series, swept bodies."""
