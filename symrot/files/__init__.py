"""Safe reading of files from unknown sources, and writing of files whole or not at all."""
