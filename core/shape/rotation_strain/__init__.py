"""Large bends without a table."""
