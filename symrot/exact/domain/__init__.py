"""Where a formula has a value, and points at which that is proven."""
