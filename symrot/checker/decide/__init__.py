"""The decision on a claim: hypotheses, constraints, conditions, real points."""
