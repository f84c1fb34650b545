"""Claims that are decided in an equivalent form: other letters, axes, signs of products, frames."""
