"""Rigid tools, their poses and contact points."""
