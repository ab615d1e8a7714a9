"""Access to Blender's scene."""
