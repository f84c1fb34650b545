"""Stores of the results of sweeps: in memory, Zarr and Parquet files, and files that workers write themselves."""
