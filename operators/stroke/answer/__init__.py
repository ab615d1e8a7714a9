"""What bodies answer to strokes: places held, fingertips led, forces and displacements."""
