"""Polynomials, fractions and relations: the ring in which a formula has a normal form."""
