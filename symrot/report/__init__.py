"""Reports for people and for other programs: summaries, tables, files and plots."""
