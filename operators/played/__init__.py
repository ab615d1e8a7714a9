"""Files that animations play from, and the modifier that plays them."""
