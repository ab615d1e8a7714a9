"""Bake: settings, prediction, the job and its child process."""
