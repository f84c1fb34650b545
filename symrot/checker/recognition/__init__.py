"""Recognition of formulas: find the formula, among all that symrot derives, to which a given one is equal."""
