"""The domain in which a formula is defined, and points proven to lie in it."""
