"""Predicted cost of an object's bake."""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...core.bake.cost.bake_cost import BakeCost
from ...core.bake.cost.prediction import edge_length_that_fits, estimate_cost
from ...core.bake.cost.size import ShapeSize, bending
from ...core.bake.settings import BakeSettings
from ...core.errors import PalpateError
from ...core.machine.available_memory import available_memory
from ...core.stiffness.pins import PinBelow, Pins
from ..pins import pin_group
from ..scene.drawn_surface import DrawnSurface


@dataclass(frozen=True)
class Prediction:
    """Cost of a bake, and settings that would fit the memory.

    Attributes
    ----------
    cost : of the bake as it is set.
    available : bytes of memory.
    compressed_fits : whether the compressed form would fit the memory.
    edge_length : smallest that fits, None if none does; the set one where it fits.
    """

    cost: BakeCost
    available: int
    compressed_fits: bool
    edge_length: float | None

    @property
    def fits(self) -> bool:
        """Whether the memory suffices."""
        return self.cost.peak_bytes <= self.available


def shape_size(drawn: DrawnSurface) -> ShapeSize:
    """Size of a drawn surface; quick also for several parts, whose overlaps count twice.


    Raises
    ------
    PalpateError
        What cannot be baked at all.
    """
    surface = drawn.surface()
    middle = surface.vertices.mean(axis=0)
    i, j, k = (surface.vertices[surface.triangles[:, corner]] - middle for corner in range(3))
    volume = abs(float(np.einsum("fx,fx->", i, np.cross(j, k)))) / 6.0
    area, triangles = float(surface.areas.sum()), len(surface.triangles)
    return ShapeSize(area, volume, surface.diagonal, triangles, bending(surface))


def pins_of(thing: bpy.types.Object, drawn: DrawnSurface) -> Pins:
    """Pins, as far as a cost depends on them; reads the vertex group if there is one."""
    settings = thing.palpate
    if settings.pin_mode == "BELOW":
        return PinBelow(settings.pin_fraction)
    try:
        return pin_group.pins(thing, drawn)
    except PalpateError:
        # Reported next to the pins; the cost is that of the whole surface then.
        return PinBelow(0.0)


def settings_of(thing: bpy.types.Object, pins: Pins) -> BakeSettings:
    """Settings of the panel, as far as the cost depends on them."""
    chosen = thing.palpate
    return BakeSettings(
        poisson_ratio=round(chosen.poisson_ratio, 6),
        pins=pins,
        edge_length=chosen.edge_length,
        epsilon=chosen.epsilon,
        decimate_above=chosen.decimate_above,
        formulation=chosen.formulation.lower(),
        form=chosen.form.lower(),
        tolerance=chosen.compression_tolerance / 100,
    )


def predict(size: ShapeSize, settings: BakeSettings) -> Prediction:
    """Predicted cost of a surface of this size on this machine now."""
    available = available_memory()
    cost = estimate_cost(size, settings, available)
    if cost.peak_bytes <= available:
        return Prediction(cost, available, True, settings.edge_length)
    compressed = estimate_cost(size, replace(settings, form="compressed"), available)
    return Prediction(
        cost,
        available,
        compressed.peak_bytes <= available,
        edge_length_that_fits(size, settings, available),
    )
