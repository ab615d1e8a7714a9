"""``object.palpate_softness``: softness in the maker's words.

The Shore value is no number of its own but Young's modulus read and set in other words: so the two
cannot disagree, and it takes effect while somebody presses, as Young's modulus does.
"""

import bpy

from ..core.errors import PalpateError
from ..core.softness.relations import RELATIONS, USUAL
from ..core.softness.shore import Shore, shore_from_young, young_from_shore

# Files hold the numbers of these items: add new ones at the end only.
SCALE_ITEMS = [
    ("00", "Shore 00", "For gels, soft silicones and foams: a ball on a light spring"),
    ("A", "Shore A", "For rubbers: a blunt cone on a stronger spring"),
]


def shore_now(thing: bpy.types.Object) -> Shore:
    """The Shore value of the object's material on the scale that is chosen.

    Raises
    ------
    PalpateError
        The material is softer or firmer than the scale says.
    """
    material = thing.palpate
    scale = thing.palpate_softness.shore_scale
    return shore_from_young(material.young_modulus, scale, material.poisson_ratio)


def _read_shore(settings: bpy.types.PropertyGroup) -> float:
    try:
        return shore_now(settings.id_data).value
    except PalpateError:
        # A property cannot refuse to be read; the panel says that this is not the material's.
        return 0.0


def _set_shore(settings: bpy.types.PropertyGroup, value: float) -> None:
    material = settings.id_data.palpate
    relation = RELATIONS[USUAL[settings.shore_scale]]
    within = min(max(value, relation.lowest), relation.highest)
    shore = Shore(settings.shore_scale, within)
    material.young_modulus = young_from_shore(shore, material.poisson_ratio)


class PalpateSoftness(bpy.types.PropertyGroup):
    """``object.palpate_softness``."""

    shore_scale: bpy.props.EnumProperty(
        name="Scale",
        description="Which durometer the Shore value is of",
        items=SCALE_ITEMS,
        default="00",
    )
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


classes = (PalpateSoftness,)


def register() -> None:
    """Give objects their softness."""
    bpy.types.Object.palpate_softness = bpy.props.PointerProperty(type=PalpateSoftness)


def unregister() -> None:
    """Take it away; files keep what is stored in them."""
    del bpy.types.Object.palpate_softness
