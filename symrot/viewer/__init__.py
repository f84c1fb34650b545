"""Animated pages: one offline HTML file per scene, which computes the motion in the browser; and films."""
