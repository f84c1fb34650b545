"""Derivations whose every step is proven when it is added, and their pages in Markdown, LaTeX and HTML."""
