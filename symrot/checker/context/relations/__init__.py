"""Relations that hold for rates of angles, tops and integrals over a body, and verdicts on claims by them."""
