"""Campaigns against certificates: corrupted files and object code, and measured rounding errors."""
