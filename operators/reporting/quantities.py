"""Quantities as words."""

from __future__ import annotations

import bpy

PREFIXES = ("", "k", "M")
# Between them a force is told in millionths, below it is none, N.
NONE, SMALL = 1e-9, 0.9995e-3


def newtons(force: float) -> str:
    """A force with three digits, never as a power of ten that must be counted.

    >>> [newtons(force) for force in (0.0, 3.55e-5, 0.00355, 1.25, 151.4, 1514.0, 2.5e6)]
    ['0 N', '35.5 µN', '0.00355 N', '1.25 N', '151 N', '1.51 kN', '2.5 MN']
    """
    if NONE <= abs(force) < SMALL:
        return f"{1e6 * force:.3g} µN"
    force = force if abs(force) >= NONE else 0.0
    times = 0
    while abs(force) >= 999.5 and times < len(PREFIXES) - 1:
        force, times = force / 1000.0, times + 1
    return f"{force:.3g} {PREFIXES[times]}N"


def scene_length(scene: bpy.types.Scene, metres: float) -> str:
    """A length in the scene's unit system."""
    system = scene.unit_settings.system
    if system == "NONE":
        return f"{metres:.4g}"
    text: str = bpy.utils.units.to_string(system, "LENGTH", metres, precision=3)
    return text
