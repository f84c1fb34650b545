"""Ensembles: many motions of one scene at once, with different initial states and different constants."""
