"""Claims read from their sources: a text, the lines of a text, or a TOML file."""
