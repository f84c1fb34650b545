"""Arguments of sines and cosines: sums of symbols, rational multiples of pi, and inverse functions such as asin."""
