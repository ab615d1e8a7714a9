"""Panels of what presses have left: layers and rigs."""
