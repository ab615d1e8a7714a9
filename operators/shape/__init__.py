"""The drawn shape and the felt force."""
