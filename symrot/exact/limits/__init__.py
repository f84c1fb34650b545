"""Limits of the effort for one decision: budgets of operations and of polynomial rings; also the size of a formula."""
