"""Kernels and steppers with which symrot is compared: handwritten in C, or made by other tools."""

from pathlib import Path

__all__ = ["BY_HAND", "text_by_hand"]

BY_HAND = Path(__file__).parent


def text_by_hand(name: str) -> str:
    """Return the text of a handwritten C file of this folder."""
    return (BY_HAND / name).read_text(encoding="utf-8")
