"""Animated pages (one offline HTML file per scene that computes the motion in the browser) and films."""
