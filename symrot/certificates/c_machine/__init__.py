"""C text that is read and run on numbers of many digits, to check that a program with loops solves its equations."""
