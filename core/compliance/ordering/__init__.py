"""Order of elimination of the freedoms."""
