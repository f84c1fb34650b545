"""The free rigid body."""
