"""Settings that an object's body was baked with, as its .blend tells them."""

from __future__ import annotations

import bpy

from ...core.bake.settings import BakeSettings


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
