"""The diagnosis of a false claim: its probable fault, and the true formulas (repairs) nearest to it."""
