"""Attacks on real processes: stopped, killed, unplugged, starved of readers."""
