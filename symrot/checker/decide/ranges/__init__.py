"""Conditions on signs, such as ``x >= 0 and pi - x >= 0``, simplified and written as a book writes them."""
