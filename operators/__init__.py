"""What a user can do, one action a file, and what these actions share."""
