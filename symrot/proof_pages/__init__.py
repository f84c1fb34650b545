"""Derivations as pages: Markdown for a code-hosting site, LaTeX for paper, HTML for a browser; one step in detail."""

from symrot.proof_pages.detail import excerpt
from symrot.proof_pages.html import html_document
from symrot.proof_pages.latex import latex_document
from symrot.proof_pages.markdown import markdown
from symrot.proof_pages.printer import formula

__all__ = ["excerpt", "formula", "html_document", "latex_document", "markdown"]
