"""Borders of passivity and stability that others have derived: referees for the simulation.

All are for a wall that is a spring, held from tick to tick. SI units.
"""

from __future__ import annotations


def passive_stiffness(damping: float, period: float) -> float:
    """Stiffest wall that is passive for any hand, N/m: b > K T / 2.

    J. E. Colgate and G. Schenkel, "Passivity of a class of sampled-data systems: application to
    haptic interfaces" (1994 and 1997), for a wall without damping.
    """
    return 2.0 * damping / period


def stable_stiffness(damping: float, period: float, delay: float) -> float:
    """Stiffest wall that is stable with a delay, N/m: b > K (T / 2 + t_d).

    J. J. Gil, E. Sanchez, T. Hulin, C. Preusche and G. Hirzinger, "Stability boundary for haptic
    rendering: influence of damping and delay" (2009), for a wall without damping and a mass that
    needs much longer than the delay to swing.
    """
    return damping / (0.5 * period + delay)


def quantised_stiffness(
    damping: float, coulomb: float, period: float, encoder_step: float
) -> float:
    """Stiffest wall that is passive with a quantised position, N/m: b >= K T / 2, f_c >= K D / 2.

    N. Diolaiti, G. Niemeyer, F. Barbagli and J. K. Salisbury, "Stability of haptic rendering:
    discretization, quantization, time delay, and Coulomb effects" (2006).
    """
    from_friction = 2.0 * coulomb / encoder_step if encoder_step > 0.0 else float("inf")
    return min(passive_stiffness(damping, period), from_friction)
