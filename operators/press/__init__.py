"""The press and its operators."""
