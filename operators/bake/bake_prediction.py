"""Predicted cost of an object's bake."""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy

from ...core.bake.cost.bake_cost import BakeCost
from ...core.bake.cost.prediction import edge_length_that_fits, estimate_cost
from ...core.bake.cost.size import ShapeSize
from ...core.bake.settings import BakeSettings
from ...core.errors import PalpateError
from ...core.machine.available_memory import available_memory
from ...core.stiffness.pins import NoPins, PinBelow, PinCore, Pins
from ..object import soft_object
from ..object.baked_settings import law_of_object
from ..pins import pin_group, stiff_region
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


def pins_of(thing: bpy.types.Object) -> Pins:
    """Pins, as far as a cost depends on them; reads the vertex group if there is one."""
    settings = thing.palpate
    if settings.pin_mode == "BELOW":
        return PinBelow(settings.pin_fraction)
    if settings.pin_mode == "CORE":
        return PinCore()
    if settings.pin_mode == "NONE":
        return NoPins()
    try:
        return pin_group.painted(thing)
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
        formulation=soft_object.formulation_now(thing),
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


def all_settings_of(thing: bpy.types.Object, drawn: DrawnSurface) -> BakeSettings:
    """Settings of a bake from the panel.

    Raises
    ------
    PalpateError
        A vertex group that is missing or empty.
    """
    chosen = thing.palpate
    return replace(
        settings_of(thing, pin_group.pins(thing, drawn)),
        young_modulus=chosen.young_modulus,
        density=chosen.density,
        law=law_of_object(thing),
        time_limit=chosen.time_limit,
        stiffness=stiff_region.stiff_region(thing, drawn),
    )
