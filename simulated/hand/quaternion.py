"""Rotations as unit quaternions (w, x, y, z): v' = q v q*. Both q and -q are the same rotation."""

from __future__ import annotations

import math

Quaternion = tuple[float, float, float, float]
UPRIGHT: Quaternion = (1.0, 0.0, 0.0, 0.0)

_NEARLY_EQUAL = 1.0 - 1e-9
"""Cosine of half the angle below which an arc equals its chord."""


def unit(quaternion: Quaternion) -> Quaternion:
    """`quaternion` with length 1; raises ValueError when it has no direction."""
    length = math.hypot(*quaternion)
    if not 0.0 < length < math.inf:
        raise ValueError(f"{quaternion} is no rotation: its length must be more than 0")
    w, x, y, z = (part / length for part in quaternion)
    return (w, x, y, z)


def about(axis: tuple[float, float, float], radians: float) -> Quaternion:
    """Rotation about `axis`, of any length; raises ValueError when that is zero."""
    length = math.hypot(*axis)
    if not 0.0 < length < math.inf:
        raise ValueError(f"{axis} is no axis: its length must be more than 0")
    x, y, z = (math.sin(0.5 * radians) * part / length for part in axis)
    return (math.cos(0.5 * radians), x, y, z)


def between(a: Quaternion, b: Quaternion, s: float) -> Quaternion:
    """Spherical linear interpolation at `s` of the shorter way from a to b, both unit
    (Shoemake 1985).
    """
    cosine = sum(p * q for p, q in zip(a, b, strict=True))
    sign = math.copysign(1.0, cosine)
    cosine = abs(cosine)
    if cosine > _NEARLY_EQUAL:
        from_a, from_b = 1.0 - s, s
    else:
        angle = math.acos(cosine)
        from_a, from_b = (math.sin(part * angle) / math.sin(angle) for part in (1.0 - s, s))
    w, x, y, z = (from_a * p + sign * from_b * q for p, q in zip(a, b, strict=True))
    return unit((w, x, y, z))
