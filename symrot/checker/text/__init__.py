"""The verdict on a claim as people type it: its readings, its lines, its units, and repairs in its notation."""
