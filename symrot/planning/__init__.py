"""From a scene to what has to be computed for it."""
