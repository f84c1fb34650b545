"""Derivations whose steps are proven when they are written, and the pages that they print."""
