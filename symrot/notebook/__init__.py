"""The pictures, tables and formulas by which a notebook shows the values of symrot."""
