"""The reader of emitted C text, which returns the rounded operations that the text performs."""
