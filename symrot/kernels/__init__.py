"""The library of kernels: what each computes, derived from its name; :mod:`symrot.codegen` prints them."""
