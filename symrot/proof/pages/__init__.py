"""Printers of derivations: Markdown for a code-hosting site, LaTeX for paper, HTML for a browser."""

from symrot.proof.pages.book import book
from symrot.proof.pages.detail import excerpt
from symrot.proof.pages.html import html_document
from symrot.proof.pages.latex import latex_book, latex_document
from symrot.proof.pages.markdown import markdown

__all__ = ["book", "excerpt", "html_document", "latex_book", "latex_document", "markdown"]
