"""Shore scales and materials."""
