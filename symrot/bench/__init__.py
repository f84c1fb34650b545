"""Measurements of speed and accuracy, each a module run as ``python -m symrot.bench.NAME``."""
