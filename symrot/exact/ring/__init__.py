"""Polynomials, fractions and relations: the ring in which each formula has a unique normal form."""
