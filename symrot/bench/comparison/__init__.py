"""Comparisons of symrot's methods with other solvers on a scene: references, work-precision studies, benchmarks."""
