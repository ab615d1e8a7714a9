"""The machine: its cores, memory and speed."""
