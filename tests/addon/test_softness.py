"""Softness in the maker's words, in Blender."""

from __future__ import annotations

import bpy
import pytest
from soft_scene import cube, error_of, mesh_state, part


def test_shore_sets_young_modulus_and_follows_it(palpate):
    thing = cube()
    material, softness = thing.palpate, thing.palpate_softness
    material.poisson_ratio = 0.48
    softness.shore = 30.0
    shore = part("core.softness.scales.shore")
    expected = shore.young_from_shore(shore.Shore("00", 30.0), material.poisson_ratio)
    assert material.young_modulus == pytest.approx(expected, rel=1e-5)
    assert material.material == "CUSTOM"
    assert softness.shore == pytest.approx(30.0, abs=1e-3)
    softness.shore_scale = "A"
    material.young_modulus = 1.142e6
    assert softness.shore == pytest.approx(29.3, abs=0.2)


def test_a_preset_reads_softer_than_its_tin_says(palpate):
    """Its modulus is that of a light touch; a durometer goes deep."""
    thing = cube()
    thing.palpate.material = "ECOFLEX_30"
    assert 10.0 < thing.palpate_softness.shore < 20.0
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


MIDDLE = (0.004, 0.003, 0.025)


def test_a_durometer_is_read_at_the_cursor_and_where_a_script_says(palpate, thing):
    thing.palpate.material = "ECOFLEX_30"
    softness = thing.palpate_softness
    assert bpy.ops.palpate.read_durometer(at=MIDDLE) == {"FINISHED"}
    by_script = softness.read_value
    assert by_script == pytest.approx(softness.read_block, abs=3)
    bpy.context.scene.cursor.location = MIDDLE
    softness.read_value = 0.0
    assert bpy.ops.palpate.read_durometer() == {"FINISHED"}
    assert softness.read_value == pytest.approx(by_script)
    assert softness.read_scale == "00"


def test_a_durometer_is_read_at_the_selected_vertices(palpate, thing):
    """Two at one end of a cube's edge: their middle, not the cursor."""
    softness = thing.palpate_softness
    softness.place = "VERTICES"
    for vertex in thing.data.vertices:
        vertex.select = False
    assert "no selected vertices" in error_of(bpy.ops.palpate.force_curve)
    chosen = [v for v in thing.data.vertices if v.co.z > 0 and v.co.x > 0]
    for vertex in chosen:
        vertex.select = True
    middle = thing.matrix_world @ (
        sum((v.co for v in chosen[1:]), chosen[0].co.copy()) / len(chosen)
    )
    bpy.context.scene.cursor.location = MIDDLE
    assert bpy.ops.palpate.force_curve(depth=0.001) == {"FINISHED"}
    at_vertices = softness.curve_force
    assert bpy.ops.palpate.force_curve(depth=0.001, at=middle) == {"FINISHED"}
    assert softness.curve_force == pytest.approx(at_vertices, rel=1e-5)
    assert bpy.ops.palpate.force_curve(depth=0.001, at=MIDDLE) == {"FINISHED"}
    assert softness.curve_force != pytest.approx(at_vertices, rel=0.05)


def test_a_force_curve_becomes_figures_and_a_text_block(palpate, thing):
    softness = thing.palpate_softness
    for radius in (0.0, 0.008):
        softness.finger_radius = radius
        assert bpy.ops.palpate.force_curve(at=MIDDLE, depth=0.001) == {"FINISHED"}
        table = bpy.data.texts[softness.curve_text].as_string().splitlines()
        assert table[0].startswith("depth_mm,force_n")
        assert float(table[-1].split(",")[0]) == pytest.approx(1.0, rel=1e-4)
        assert float(table[-1].split(",")[1]) == pytest.approx(softness.curve_force, rel=1e-4)
    assert len(bpy.data.texts) == 1


def test_the_map_colours_vertices_and_changes_nothing_else(palpate, thing):
    mesh = thing.data
    before = mesh_state(thing)
    mesh.color_attributes.new("Paint", "BYTE_COLOR", "CORNER")
    mesh.color_attributes.active_color_name = mesh.color_attributes.default_color_name = "Paint"
    assert bpy.ops.palpate.map_softness() == {"FINISHED"}
    assert mesh.color_attributes.active_color_name == "Palpate Softness"
    assert mesh.color_attributes.default_color_name == "Paint"
    colours = mesh.color_attributes["Palpate Softness"]
    assert (colours.domain, colours.data_type) == ("POINT", "FLOAT_COLOR")
    top = max(range(8), key=lambda v: mesh.vertices[v].co.z)
    base = min(range(8), key=lambda v: mesh.vertices[v].co.z)
    # Corners on top give way more than those that are pinned: darker, less green.
    assert colours.data[top].color[1] < colours.data[base].color[1]
    assert 0 < thing.palpate_softness.map_low < thing.palpate_softness.map_high
    softness = [mesh.attributes["palpate_softness"].data[v].value for v in (top, base)]
    low, high = thing.palpate_softness.map_low, thing.palpate_softness.map_high
    # N/mm to m/N; corners are beyond the colours.
    assert 0.3e-3 / high < softness[1] < softness[0] < 3e-3 / low
    # Again, over the old one, and away with it.
    assert bpy.ops.palpate.map_softness() == {"FINISHED"}
    assert bpy.ops.palpate.remove_softness_map() == {"FINISHED"}
    assert [attribute.name for attribute in mesh.color_attributes] == ["Paint"]
    assert mesh.color_attributes.active_color_name == "Paint"
    assert "palpate_softness" not in mesh.attributes
    assert mesh_state(thing) == before
    assert "no softness map" in error_of(bpy.ops.palpate.remove_softness_map)


def test_what_is_not_soft_cannot_be_measured(palpate):
    cube()
    for operator in ("read_durometer", "force_curve", "map_softness"):
        assert "not soft yet" in error_of(getattr(bpy.ops.palpate, operator))
