"""Where a swept motion is: which times reach resonance, and how many rad there are to count."""

from typing import NamedTuple

__all__ = ["Span"]

_DOUBT = 1e-14  # of a place: nearer to the edge of a side than this, it could be on either


class Span(NamedTuple):
    """What decides how a motion is evaluated, in doubles: times are scaled by ``scale``, rates by its inverse."""

    scale: float
    edge: float
    start: float
    s: float
    across: float
    whole: bool
    turn: float
    growth: float

    def far(self, first: float, last: float) -> bool:
        """Return whether all times between two are surely on one side of resonance, however doubles round."""
        ends = self.start + self.s * first * self.scale, self.start + self.s * last * self.scale
        edge = self.edge + _DOUBT * (self.edge + max(abs(self.start), abs(ends[0]), abs(ends[1])))
        return self.whole or ends[1] <= -edge or ends[0] >= edge

    def phase(self, time: float) -> float:
        """Return more rad than either phase of a motion has at a time."""
        scaled = time * self.scale
        return scaled * (abs(self.start) + self.across + abs(self.turn) + (self.s + abs(self.growth)) * scaled)
