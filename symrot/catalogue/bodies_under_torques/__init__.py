"""Bodies under torques: heavy tops, wheels, gyrostats, the gravity gradient."""
