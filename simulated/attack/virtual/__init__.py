"""Attacks in virtual time: the servo's own ticks, and the line in memory."""
