"""Bodies that meet themselves: what is drawn does not pass through itself."""
