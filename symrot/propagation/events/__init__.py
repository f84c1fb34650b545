"""Events: the times at which a formula of the motion is zero."""
