"""Softness in the maker's words, in Blender."""

from __future__ import annotations

import bpy
import pytest
from soft_scene import cube, part


def test_shore_sets_young_modulus_and_follows_it(palpate):
    thing = cube()
    material, softness = thing.palpate, thing.palpate_softness
    material.poisson_ratio = 0.48
    softness.shore = 30.0
    shore = part("core.softness.shore")
    expected = shore.young_from_shore(shore.Shore("00", 30.0), material.poisson_ratio)
    assert material.young_modulus == pytest.approx(expected, rel=1e-5)
    assert material.material == "CUSTOM"
    assert softness.shore == pytest.approx(30.0, abs=1e-3)
    softness.shore_scale = "A"
    material.young_modulus = 1.142e6
    assert softness.shore == pytest.approx(29.3, abs=0.2)


def test_presets_show_what_their_tin_says(palpate):
    thing = cube()
    thing.palpate.material = "ECOFLEX_30"
    assert thing.palpate_softness.shore == pytest.approx(30.0, abs=0.1)
    assert thing.palpate.material == "ECOFLEX_30"


def test_beyond_the_scale_nothing_is_changed_by_reading_and_setting_stays_within(palpate):
    thing = cube()
    thing.palpate.young_modulus = 1000.0
    assert thing.palpate_softness.shore == 0.0
    assert thing.palpate.young_modulus == 1000.0
    thing.palpate_softness.shore = 99.0
    assert thing.palpate_softness.shore == pytest.approx(90.0, abs=1e-3)


def test_files_from_before_keep_their_material(palpate, tmp_path):
    """A .blend holds the numbers of the items, and Custom was number 7."""
    items = bpy.types.Object.bl_rna.properties["palpate"].fixed_type.properties["material"]
    numbers = {item.identifier: item.value for item in items.enum_items}
    old = ["PLUSH", "JELLY", "PAPER_CUBE", "FOAM", "SILICONE_SOFT", "SILICONE_FIRM", "RUBBER"]
    assert [numbers[name] for name in old] == list(range(7))
    assert numbers["CUSTOM"] == 7
    assert len(set(numbers.values())) == len(numbers)
