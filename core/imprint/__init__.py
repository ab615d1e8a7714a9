"""Imprints: what stays of a press, as in clay, and fades, as in memory foam."""
