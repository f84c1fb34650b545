"""Formula trees, exact numbers, programs and switches: standard library only."""
