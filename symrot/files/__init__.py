"""Safe reading of files of unknown origin, and writing that never leaves an incomplete file."""
