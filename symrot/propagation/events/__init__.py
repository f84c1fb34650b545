"""Events: the times at which a formula of time and states is zero along a motion."""
