"""Motions under torques that jump or bend, such as dry friction: smooth parts between accurately located switches."""
