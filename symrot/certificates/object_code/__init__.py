"""Object code compared with the C text it was compiled from, rounding for rounding."""
