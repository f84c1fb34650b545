"""Comparisons of symrot's methods with other solvers on one scene: references, work-precision studies, the suite."""
