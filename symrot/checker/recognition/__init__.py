"""Recognition of formulas: which of the formulas that symrot derives is equal to a given formula."""
