"""Relations for rates of angles, tops and integrals over a body, and functions that decide claims with them."""
