"""Read emitted C back as the operations that it computes."""
