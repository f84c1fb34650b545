"""The reader of formulas as people type them: tokens, words that may be several names, and the grammar."""
