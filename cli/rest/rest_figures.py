"""Figures of a body that rests."""

from __future__ import annotations

import numpy as np

from ...core.rest.rest import BodyTouch, Rest


def rest_figures(rest: Rest, young_modulus: float) -> dict[str, object]:
    """Where the body lies and what bears it, as plain values; SI units, in the world. Young's
    modulus is that of its material.
    """
    return {
        "position": rest.placement.position.tolist(),
        "rotation": rest.placement.rotation.tolist(),
        "centre_of_mass": rest.centre.tolist(),
        "mass_kg": rest.body.mass,
        "floor": touch_figures(rest.supports[0]),
        "max_displacement": float(np.linalg.norm(rest.displacements(), axis=1).max()),
        "elastic_energy": rest.elastic,
        "young_modulus": young_modulus,
    }


def touch_figures(touch: BodyTouch) -> dict[str, object]:
    """Force on a tool or the floor, and the patch, in the world."""
    return {
        "force": touch.force.tolist(),
        "torque": touch.torque.tolist(),
        "pressed_points": len(touch.places),
        "pressed_area_m2": float(touch.areas.sum()),
        "largest_pressure_pa": float(touch.pressures.max(initial=0.0)),
    }
