"""Read files that may be anything, and write files whole or not at all."""
