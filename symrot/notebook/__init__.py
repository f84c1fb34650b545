"""Pictures, tables and formulas as which a notebook displays symrot's objects: trajectories, verdicts, .."""
