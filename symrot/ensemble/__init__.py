"""Many motions of one scene at once: other initial states, other values of its constants."""
