"""The bake: settings, prediction, the job and its child process."""
