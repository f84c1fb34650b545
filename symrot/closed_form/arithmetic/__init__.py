"""Exact numbers, sums of two doubles (double-double arithmetic), and changes of axes, which all closed forms use."""
