"""Quantities as words."""

from __future__ import annotations

PREFIXES = ("", "k", "M")


def newtons(force: float) -> str:
    """A force with three digits, never as a power of ten that must be counted.

    >>> [newtons(force) for force in (0.00355, 1.25, 151.4, 1514.0, 2.5e6)]
    ['0.00355 N', '1.25 N', '151 N', '1.51 kN', '2.5 MN']
    """
    times = 0
    while abs(force) >= 999.5 and times < len(PREFIXES) - 1:
        force, times = force / 1000.0, times + 1
    return f"{force:.3g} {PREFIXES[times]}N"
