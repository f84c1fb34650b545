"""The decision on a claim: its stages, with hypotheses, conditions and real points."""
