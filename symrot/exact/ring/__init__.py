"""Polynomials, fractions and relations: the ring of polynomials in which each formula has a unique normal form."""
