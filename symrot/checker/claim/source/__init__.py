"""Claims from their sources: from one text, from the lines of a text, or from a TOML file."""
