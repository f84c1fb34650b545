"""The search for known formulas that differ from a claim's formula by one fault, such as a lost square."""
