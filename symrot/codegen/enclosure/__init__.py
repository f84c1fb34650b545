"""The enclosure of a right-hand side: which terms it needs, and its C."""
