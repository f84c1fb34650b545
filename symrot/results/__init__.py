"""Results of motions with their labels, and their tables for pandas and xarray."""
