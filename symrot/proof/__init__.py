"""Write derivations whose every step is proven when it is added, and print them as pages."""
