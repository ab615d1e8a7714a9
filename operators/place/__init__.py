"""Places of a soft object as it is seen, and at rest."""
