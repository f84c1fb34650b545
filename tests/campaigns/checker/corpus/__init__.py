"""Printed formulas that judge `symrot check`: one TOML file per chapter, with an independent numeric oracle in
verify.py.
"""
