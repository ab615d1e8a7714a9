"""Imprints of soft objects: what stays of their presses, and fades as time goes on."""
