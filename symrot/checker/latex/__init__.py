"""Read LaTeX into the trees of claims."""
