"""The wire between board and host."""
