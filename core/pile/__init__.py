"""Soft bodies that press each other, on floors and fixed tools, pressed by others."""
