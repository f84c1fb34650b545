"""Certificates of exact steps: that the C text is the motion, and bounds of its errors in double precision."""
