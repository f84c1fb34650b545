"""Reports on the checked formulas of four textbooks and courses: a table, JSON data, and the pages of errata."""

from symrot.report.errata.entries import Survey, survey
from symrot.report.errata.page import html, page
from symrot.report.errata.table import facts, lines

__all__ = ["Survey", "facts", "html", "lines", "page", "survey"]
