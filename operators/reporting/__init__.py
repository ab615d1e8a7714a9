"""What operators report, and how they refuse, in the user's language."""
