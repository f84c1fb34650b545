"""Printed formulas that judge `symrot check`: one TOML file per chapter of the subject, with an independent numeric oracle in verify.py."""
