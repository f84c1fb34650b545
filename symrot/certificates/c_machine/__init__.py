"""A machine that reads C text and runs it on numbers of many digits, to check that the text solves its equations."""
