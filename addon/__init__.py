"""What Blender shows and keeps."""
