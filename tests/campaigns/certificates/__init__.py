"""Campaigns against certificates: corrupted files and object code, measured rounding errors."""
