"""The decision on a claim: hypotheses, the constraints that they are, conditions, and real points."""
