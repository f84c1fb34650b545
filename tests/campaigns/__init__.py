"""Campaigns of random problems against truths that share no code with symrot; run by hand, not by pytest."""
