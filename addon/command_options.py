"""Options of ``blender -c palpate`` that set properties."""

import argparse

import bpy

from ..core.errors import PalpateError

# Numeric options: the property that each sets, and its unit.
NUMBERS = {
    "young": ("young_modulus", 1.0),
    "poisson": ("poisson_ratio", 1.0),
    "edge_length": ("edge_length", 1.0),
    "epsilon": ("epsilon", 1.0),
    "time_limit": ("time_limit", 1.0),
    "stiff_factor": ("stiff_factor", 1.0),
    "tolerance": ("compression_tolerance", 0.01),
}


def set_young(thing: bpy.types.Object, arguments: argparse.Namespace) -> None:
    """Set Young's modulus of an object, where it was given."""
    if arguments.young is not None:
        young = within(thing.palpate, "young_modulus", "young", arguments.young)
        thing.palpate.young_modulus = young


def set_up(settings: bpy.types.PropertyGroup, arguments: argparse.Namespace) -> None:
    """Set the panel's properties from the options."""
    if arguments.material:
        settings.material = arguments.material
    if arguments.pin_below is not None:
        settings.pin_mode, settings.pin_fraction = "BELOW", arguments.pin_below
    if arguments.pin_group is not None:
        settings.pin_mode, settings.pin_group = "GROUP", arguments.pin_group
    if arguments.stiff_group is not None:
        settings.stiff_group = arguments.stiff_group
    if arguments.stiff_factor is not None and not settings.stiff_group:
        raise PalpateError("--stiff-factor: nothing is stiff; name a group by --stiff-group")
    for name in ("formulation", "form"):
        if getattr(arguments, name) is not None:
            setattr(settings, name, getattr(arguments, name).upper())
    for option, (name, unit) in NUMBERS.items():
        value = getattr(arguments, option)
        if value is not None:
            setattr(settings, name, within(settings, name, option, value, unit))


def within(
    settings: bpy.types.PropertyGroup, name: str, option: str, value: float, unit: float = 1.0
) -> float:
    """Value of a property for an option given in its ``unit``; refused where Blender would clamp
    it silently.
    """
    allowed = settings.bl_rna.properties[name]
    # The bounds are float32, and inclusive.
    rounding = 1e-6
    lowest, highest = allowed.hard_min * (1 - rounding), allowed.hard_max * (1 + rounding)
    if not lowest <= value / unit <= highest:
        raise PalpateError(
            f"--{option.replace('_', '-')}: {value:g} is out of range; give a number from "
            f"{unit * allowed.hard_min:g} to {unit * allowed.hard_max:g}"
        )
    return value / unit
