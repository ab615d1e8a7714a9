"""Palpate: soft props that can be touched at 1 kHz."""
