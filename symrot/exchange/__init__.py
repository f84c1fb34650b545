"""Bodies from files of other programs: meshes and robot descriptions."""
