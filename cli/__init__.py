"""The command line ``palpate``: one command a file."""
