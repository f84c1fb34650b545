"""Figures of derivations, drawn as SVG from exact motions and from the maps and matrices that symrot derives."""
