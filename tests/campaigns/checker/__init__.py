"""Campaigns against the checker: generated claims whose truth is known by other means."""
