"""Units of the quantities in a claim, and the check that its terms have the same units."""
