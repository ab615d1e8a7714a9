"""Frames of an animation, pressed one after the other, and what presses in them."""
