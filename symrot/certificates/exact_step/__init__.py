"""Certificates of exact steps: the C text computes the exact motion, up to errors in double precision with bounds."""
