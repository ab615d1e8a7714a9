"""What is drawn into the view."""
