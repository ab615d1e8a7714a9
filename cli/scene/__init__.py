"""Scene files: several bodies that press each other."""
