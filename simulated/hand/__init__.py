"""The hand and the handle it moves."""
