"""Arguments of sines and cosines: sums of atoms, rational multiples of pi, inverse functions."""
