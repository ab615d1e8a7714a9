"""What Blender keeps with objects, scenes and preferences."""
