"""Closed forms of rigid indenters of revolution on an elastic half-space, without friction.

Forces are in units of the plane-strain modulus E* = E / (1 - nu^2): newton per pascal, that is m2.
Contact radius a, depth h, force F:

flat punch        F = 2 E* a h                                         Boussinesq 1885
ball, parabola    F = 4/3 E* sqrt(R) h^(3/2)                           Hertz 1882
ball, exact       h = a/2 ln((R+a)/(R-a)),
                  F = E* ((R^2+a^2)/2 ln((R+a)/(R-a)) - a R)           Segedin 1957, Sneddon 1965
truncated cone    h = a cot(theta) phi,  cos(phi) = tip/a,
                  F = E* a^2 cot(theta) (phi + sin(phi) cos(phi))      Sneddon 1965
Beyond the shaft's radius the contact stops growing; further depth adds the force of a flat punch.
"""

from __future__ import annotations

import math

from scipy.optimize import brentq

from .durometer_type import DurometerType

# Share of a ball's radius beyond which its depth exceeds every durometer's travel.
FULLEST_CONTACT = 1.0 - 1e-12


def flat_punch_force(radius: float, depth: float) -> float:
    """Force over E* (m2) of a flat punch of ``radius`` pressed in by ``depth``, metres."""
    return 2.0 * radius * depth


def hertz_force(radius: float, depth: float) -> float:
    """Force over E* (m2) of a paraboloid of this radius of curvature."""
    return 4.0 / 3.0 * math.sqrt(radius * depth) * depth


def ball_force(radius: float, depth: float) -> float:
    """Force over E* (m2) of a ball of ``radius``, its shape exact."""
    if depth <= 0.0:
        return 0.0
    wanted = depth / radius
    share = float(brentq(lambda x: x * math.atanh(x) - wanted, 0.0, FULLEST_CONTACT, xtol=1e-15))
    return radius**2 * ((1.0 + share**2) * math.atanh(share) - share)


def rubber_ball_force(radius: float, depth: float) -> float:
    """Force over E* (m2) of a ball on a shaft of its ``radius`` on neo-Hookean rubber.

    Hertz's, less what was computed by quadratic finite elements of a Poisson's ratio of 0.49 to a
    depth of 1.9 radii (``benchmarks/contact/rubber_ball.py``); fitted to 0.6 %.
    """
    share = depth / radius
    return hertz_force(radius, depth) * (1.0 - (0.1483 + 0.0106 * share) * share)


def cone_force(tip: float, shaft: float, half_angle: float, depth: float) -> float:
    """Force over E* (m2) of a truncated cone with a flat end of radius ``tip`` that continues
    as a cylinder of radius ``shaft``; ``half_angle`` in radians.
    """
    if depth <= 0.0:
        return 0.0
    slope = 1.0 / math.tan(half_angle)

    def depth_of(a: float) -> float:
        return a * slope * math.acos(tip / a)

    def force_of(a: float) -> float:
        phi = math.acos(tip / a)
        return a**2 * slope * (phi + math.sin(phi) * math.cos(phi))

    full = depth_of(shaft)
    if depth >= full:
        return force_of(shaft) + flat_punch_force(shaft, depth - full)
    return force_of(float(brentq(lambda a: depth_of(a) - depth, tip, shaft, xtol=1e-15)))


def indenter_force(kind: DurometerType, depth: float) -> float:
    """Force over E* (m2) of a durometer's indenter at this depth below the undeformed surface."""
    if kind.tip > 0.0:
        return cone_force(kind.tip, kind.shaft, kind.half_angle, depth)
    return ball_force(kind.shaft, depth)
