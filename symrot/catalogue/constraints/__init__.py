"""Constraints: rolling, gear trains, planar linkages."""
