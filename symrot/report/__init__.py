"""What people and other programs read of a motion: summaries, tables, files, plots, health."""
