"""Animations: tools that press through the frames of a scene, kept so that the file plays."""
