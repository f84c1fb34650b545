"""Recognise a formula among those that symrot derives."""
