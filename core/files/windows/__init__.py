"""What Windows asks of files: patience, sharing, room for what is in use, a form for long paths."""
