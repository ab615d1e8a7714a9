"""Properties of an object: its material."""

import math
from collections.abc import Callable

import bpy

from ...core.compliance.free_body.density import LEAST_DENSITY, MOST_DENSITY
from ...core.law.relaxation import RELAXATIONS
from ...core.softness.scales.materials import MATERIALS, Material
from .kinds import choice, number, result, span

# Files hold the numbers of these items: add new ones at the end only.
CUSTOM = "CUSTOM"
# Custom came before all materials but the first seven.
CUSTOM_NUMBER = 7
MATERIAL_ITEMS = [
    *(
        (
            name,
            material.name,
            f"{material.young_modulus:,.0f} Pa, {material.poisson_ratio:g}; {material.basis}",
            number if number < CUSTOM_NUMBER else number + 1,
        )
        for number, (name, material) in enumerate(MATERIALS.items())
    ),
    (CUSTOM, "Custom", "Young's modulus and Poisson's ratio as set below", CUSTOM_NUMBER),
]
RELAXATION_HINTS = {
    "NONE": "Gives way at once and comes back at once",
    "MEMORY_FOAM": "Firm at first, gives way within seconds, and comes back as slowly",
    "FLESH": "Firmer for a moment than for long",
    "GEL": "Gives way a little more over tens of seconds",
    "CHEWING_GUM": "Firm when it is hit, soft when it is pressed for long",
}

RELAXATION_ITEMS = [
    (key, relaxation.name, RELAXATION_HINTS[key]) for key, relaxation in RELAXATIONS.items()
]


def _take_material(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    material = MATERIALS.get(settings.material)
    if material is not None:
        settings.young_modulus = material.young_modulus
        settings.poisson_ratio = material.poisson_ratio
        settings.density = material.density
        settings.relaxation = material.relaxation
        settings.law = material.law


def _leave_material(name: str) -> Callable[[bpy.types.PropertyGroup, bpy.types.Context], None]:
    """Update callback that sets Custom once the number ``name`` differs from the preset's."""

    def update(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
        material = MATERIALS.get(settings.material)
        if material is not None and not math.isclose(
            getattr(settings, name), getattr(material, name), rel_tol=1e-5
        ):
            _leave(settings, material)

    return update


def _leave_relaxation(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    material = MATERIALS.get(settings.material)
    if material is not None and settings.relaxation != material.relaxation:
        _leave(settings, material)


def _leave(settings: bpy.types.PropertyGroup, material: Material) -> None:
    """Custom, of the same law."""
    settings.law = settings.law or material.law
    settings.material = CUSTOM


class MaterialProperties:
    """Part of ``object.palpate`` for the material."""

    material: choice(
        "Material",
        "A usual soft material, as a start",
        MATERIAL_ITEMS,
        "PLUSH",
        update=_take_material,
    )
    young_modulus: number(
        "Young's Modulus",
        "Stiffness in pascal. Takes effect at once, without a new bake",
        1000.0,
        span(1.0, 1e9, soft_max=1e6, precision=0, step=10000),
        update=_leave_material("young_modulus"),
    )
    poisson_ratio: number(
        "Poisson's Ratio",
        "How much it bulges sideways: 0 like cork, near 0.5 like rubber or water. "
        "Needs Rebuild Body",
        0.3,
        span(0.0, 0.499, precision=3, step=1),
        update=_leave_material("poisson_ratio"),
    )
    density: number(
        "Density",
        "What a cubic metre weighs, kg. Only a body without pins has weight. Takes effect at once",
        MATERIALS["PLUSH"].density,
        span(LEAST_DENSITY, MOST_DENSITY, soft_min=10.0, soft_max=3000.0, precision=0, step=1000),
        update=_leave_material("density"),
    )
    relaxation: choice(
        "Gives Way",
        "How the body gives way with time while a press runs, felt and seen",
        RELAXATION_ITEMS,
        "NONE",
        update=_leave_relaxation,
    )
    law: result("")
