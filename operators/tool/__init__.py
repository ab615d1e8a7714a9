"""Objects as tools."""
