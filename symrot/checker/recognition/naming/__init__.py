"""Verdicts on claims that only give a formula for a named quantity: recognised, doubtful, or perhaps a definition."""
