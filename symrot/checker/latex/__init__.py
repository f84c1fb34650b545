"""The LaTeX reader of the checker: it parses LaTeX into the trees of claims."""
