"""What is asked of Blender's scene."""
