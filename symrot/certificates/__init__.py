"""Certificates of emitted kernels: read back, bounded, compared with the object code, and re-checked."""
