"""Free bodies: invariants, symmetric and asymmetric bodies, Poinsot's construction."""
