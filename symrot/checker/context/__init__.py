"""The context that a person states in words: meanings of names, the body, the frame and the sequence of angles."""
