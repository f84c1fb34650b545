"""Units of the quantities of a claim, and the check that its terms agree in them."""
