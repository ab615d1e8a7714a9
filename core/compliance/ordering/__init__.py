"""The order in which freedoms are eliminated."""
