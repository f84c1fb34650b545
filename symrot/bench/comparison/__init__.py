"""Symrot's methods and other solvers on one scene: the references, the work-precision study, the suite."""
