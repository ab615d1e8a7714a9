"""Tables of equation (16)."""
