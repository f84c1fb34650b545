"""Recognition of formulas: finding the formula, among those that symrot derives, to which a formula is equal."""
