"""What an object keeps of its softness."""
