"""Safe reading of files of unknown origin, and writing of files that are never left incomplete."""
