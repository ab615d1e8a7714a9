"""Settings that an object's body was baked with, as its .blend tells them."""

from __future__ import annotations

import bpy

from ...core.bake.settings import BakeSettings
from ...core.law.of_material import RUBBER, law_checked
from ...core.softness.scales.materials import MATERIALS


def settings_of(thing: bpy.types.Object) -> BakeSettings:
    """Material, formulation and form of the object's body, checked: a file may be a stranger's.

    Raises
    ------
    PalpateError
        A value that no bake takes; names it.
    """
    baked = thing.palpate
    return BakeSettings(
        # A property holds it in single precision.
        round(baked.baked_poisson_ratio, 6),
        baked.young_modulus,
        formulation=baked.baked_formulation,
        form=baked.baked_form,
        tolerance=baked.baked_tolerance / 100,
        density=baked.density,
    ).checked()


def law_of_object(thing: bpy.types.Object) -> str:
    """Name of its material's law: what the preset said, or for objects whose material nobody chose,
    and of older files, what it says.

    Raises
    ------
    PalpateError
        An unknown one.
    """
    chosen = thing.palpate
    preset = MATERIALS.get(chosen.material)
    return law_checked(chosen.law or (RUBBER if preset is None else preset.law))
