"""Pictures, tables and formulas that a notebook displays for symrot's objects: trajectories, verdicts, .."""
