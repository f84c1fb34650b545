"""Inertia of bodies: solids by exact integration, bodies of several parts, and principal axes."""
