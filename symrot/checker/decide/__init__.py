"""The decision of whether a claim is true: its stages, hypotheses, conditions, and real points as counterexamples."""
