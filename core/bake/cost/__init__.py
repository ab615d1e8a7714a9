"""Cost of a bake, predicted before it starts: nodes, time, memory, size of the file."""
