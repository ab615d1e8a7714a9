"""State of a soft object and its body."""
