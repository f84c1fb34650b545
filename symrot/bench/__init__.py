"""Measurements, each a module run as ``python -m symrot.bench.NAME``."""
