"""What a touch is: equations (9) to (14)."""
