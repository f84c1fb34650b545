"""The symmetric heavy top."""
