"""Certificates of emitted time steps: made for a scene, and audited from their files."""
