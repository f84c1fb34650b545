"""Recognition of formulas: a look-up of the formula, among those that symrot derives, to which a formula is equal."""
