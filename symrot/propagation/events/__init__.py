"""Events: the times at which a formula of time and states becomes zero along a motion."""
