"""Strokes: a patch of a soft object is pushed, pulled, grabbed, twisted or pinched, and kept."""
