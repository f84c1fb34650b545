"""Benchmarks of speed and accuracy; each module runs as ``python -m symrot.bench.NAME``."""
