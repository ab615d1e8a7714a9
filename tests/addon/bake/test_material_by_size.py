"""Make Soft by hand gives an object a material that suits its size, unless somebody chose one."""

from __future__ import annotations

import bpy
import pytest
from recorded_layout import drawn
from soft_scene import cube, part, soft_cube


def suit(thing):
    return part("operators.bake.make_soft").suit_to_size(thing, bpy.context.scene)


@pytest.mark.parametrize(("edge", "material"), [(2.0, "PLUSH"), (0.02, "SILICONE_SOFT")])
def test_a_material_suits_the_size(palpate, edge, material):
    thing = cube(edge)
    suit(thing)
    assert thing.palpate.material == material
    chosen = part("core.softness.scales.materials").MATERIALS[material]
    assert thing.palpate.young_modulus == pytest.approx(chosen.young_modulus)
    assert thing.palpate.poisson_ratio == pytest.approx(chosen.poisson_ratio)


def test_the_size_is_that_of_the_scene(palpate):
    bpy.context.scene.unit_settings.scale_length = 0.001
    thing = cube(20.0)
    assert suit(thing) == pytest.approx(0.02 * 3**0.5)


@pytest.mark.parametrize(
    ("name", "value"), [("material", "PLUSH"), ("young_modulus", 1000.0), ("poisson_ratio", 0.3)]
)
def test_what_somebody_said_stays(palpate, name, value):
    thing = cube(0.02)
    setattr(thing.palpate, name, value)
    assert suit(thing) is None
    assert thing.palpate.young_modulus == 1000.0


def test_a_soft_object_keeps_its_material(palpate):
    thing = soft_cube()
    assert suit(thing) is None
    assert thing.palpate.material == "PLUSH"


def test_the_panel_says_beforehand_what_make_soft_will_choose(palpate):
    panel = part("addon.panels.sidebar").PALPATE_PT_main
    thing = cube(0.02)
    assert "silicone" in drawn(panel, thing).text
    assert "by size" in drawn(panel, thing).text
    suit(thing)
    assert "by size" not in drawn(panel, thing).text
