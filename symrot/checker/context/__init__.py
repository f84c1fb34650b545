"""What a person says about a claim in words: the meaning of names, the body, the frame and the sequence of angles."""
