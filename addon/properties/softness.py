"""``object.palpate_softness``: softness in makers' words.

The Shore value is computed from Young's modulus and sets it: so the two cannot disagree, and both
take effect during a press.
"""

import bpy

from ...core.errors import PalpateError
from ...core.softness.ramp import ramp
from ...core.softness.scales.relations import RELATIONS, USUAL
from ...core.softness.scales.shore import Shore, shore_from_young, young_from_shore
from .kinds import choice, number, result, span

# Files hold the numbers of these items: add new ones at the end only.
SCALE_ITEMS = [
    ("00", "Shore 00", "For gels, soft silicones and foams: a ball on a light spring"),
    ("A", "Shore A", "For rubbers: a blunt cone on a stronger spring"),
]
PLACE_ITEMS = [
    ("CURSOR", "3D Cursor", "The surface point nearest to the 3D cursor"),
    (
        "VERTICES",
        "Selected Vertices",
        "The surface point nearest to the middle of the vertices selected in Edit Mode",
    ),
]
LEGEND_STEPS = 5


def shore_now(thing: bpy.types.Object) -> Shore:
    """Shore value of the object's material on the chosen scale.

    Raises
    ------
    PalpateError
        The material is beyond the scale.
    """
    material = thing.palpate
    scale = thing.palpate_softness.shore_scale
    return shore_from_young(material.young_modulus, scale, material.poisson_ratio)


def _read_shore(settings: bpy.types.PropertyGroup) -> float:
    try:
        return shore_now(settings.id_data).value
    except PalpateError:
        # A property cannot refuse to be read; the panel shows that this is not the material's.
        return 0.0


def _set_shore(settings: bpy.types.PropertyGroup, value: float) -> None:
    material = settings.id_data.palpate
    relation = RELATIONS[USUAL[settings.shore_scale]]
    within = min(max(value, relation.lowest), relation.highest)
    shore = Shore(settings.shore_scale, within)
    material.young_modulus = young_from_shore(shore, material.poisson_ratio)


def legend_colour(step: int) -> bpy.props.FloatVectorProperty:
    """Colour of the map's legend, read-only."""
    colour = tuple(ramp([step / (LEGEND_STEPS - 1)])[0].tolist())
    return bpy.props.FloatVectorProperty(
        name="Colour",
        description="A colour of the map",
        size=3,
        subtype="COLOR_GAMMA",
        min=0.0,
        max=1.0,
        get=lambda _: colour,
        # Without a setter it would be drawn as disabled, darker than it is.
        set=lambda _, __: None,
        options={"HIDDEN"},
    )


class PalpateSoftness(bpy.types.PropertyGroup):
    """``object.palpate_softness``."""

    shore_scale: choice("Scale", "Which durometer the Shore value is of", SCALE_ITEMS, "00")
    shore: bpy.props.FloatProperty(
        name="Shore",
        description="Softness as data sheets tell it, from 10 to 90: what a durometer reads on a "
        "thick block. Sets Young's modulus, and follows it",
        min=0.0,
        max=100.0,
        precision=0,
        step=100,
        get=_read_shore,
        set=_set_shore,
    )
    place: choice(
        "Measured At",
        "Where durometer and curve press, unless you click a place",
        PLACE_ITEMS,
        "CURSOR",
    )
    finger_radius: number(
        "Fingertip Radius",
        "How large what presses is, for curve and map; 0 for a point",
        0.005,
        span(0.0, soft_max=0.05, precision=4, step=0.1, subtype="DISTANCE"),
    )
    colours_0: legend_colour(0)
    colours_1: legend_colour(1)
    colours_2: legend_colour(2)
    colours_3: legend_colour(3)
    colours_4: legend_colour(4)

    # Latest results, written by the operators only; lengths in mm, stiffness in N/mm.
    read_scale: result("")
    read_value: result(0.0)
    read_block: result(0.0)
    read_warnings: result("")
    curve_text: result("")
    curve_depth: result(0.0)
    curve_force: result(0.0)
    curve_stiffness: result(0.0)
    map_low: result(0.0)
    map_high: result(0.0)
    shown_before: result("")


classes = (PalpateSoftness,)


def register() -> None:
    """Add the properties to objects."""
    bpy.types.Object.palpate_softness = bpy.props.PointerProperty(type=PalpateSoftness)


def unregister() -> None:
    """Remove the properties; files keep their values."""
    del bpy.types.Object.palpate_softness
