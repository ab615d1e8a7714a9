"""Formulation, form and stiff region through the panel's settings: baked, restored, said."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
import pytest
from soft_scene import body_of, cube, error_of, locate, part, press_down, select, status


def boned_cube(factor=1000.0):
    """A cube with a small cube inside it, the small one in the group Bone."""
    thing = cube()
    form = bmesh.new()
    form.from_mesh(thing.data)
    inner = bmesh.ops.create_cube(form, size=0.024)["verts"]
    form.to_mesh(thing.data)
    count = len(inner)
    form.free()
    bone = range(len(thing.data.vertices) - count, len(thing.data.vertices))
    thing.vertex_groups.new(name="Bone").add(bone, 1.0, "REPLACE")
    thing.palpate.stiff_group, thing.palpate.stiff_factor = "Bone", factor
    return select(thing)


@pytest.mark.parametrize("kept", ["SMOOTHED", "AUTO"])
def test_bodies_of_older_files_that_were_linear_by_default_stay_baked(palpate, thing, kept):
    thing.palpate.baked_formulation, thing.palpate.formulation = "linear", kept
    assert status(thing).changed == ()
    thing.palpate.poisson_ratio = 0.49
    assert status(thing).changed == ("Poisson's Ratio", "Formulation")


def test_a_stiff_region_is_baked_in_and_embedded(palpate):
    thing = boned_cube()
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    body = body_of(thing)
    stiff = body.young_scale > 500
    assert 0.5 < body.mesh.tet_volumes[stiff].sum() / 0.024**3 < 1.5
    middles = body.mesh.nodes[body.mesh.tets[stiff]].mean(axis=1)
    assert np.abs(middles).max() < 0.013
    key = thing.palpate.body_key
    assert np.array_equal(np.array(thing.palpate["young_scale"]), body.young_scale)
    locate(thing).unlink()
    press_down(thing)
    assert thing.palpate.body_key == key, "Press restored another body"
    locate(thing).unlink()
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    assert thing.palpate.body_key == key, "Rebuild Body made another body"
    assert np.array_equal(body_of(thing).young_scale, body.young_scale)


@pytest.mark.at_length
def test_a_changed_stiff_region_is_said_and_taken_over(palpate):
    thing = boned_cube()
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    assert status(thing).changed == ()
    scale = body_of(thing).young_scale
    thing.palpate.stiff_factor = 10.0
    assert status(thing).changed == ("Stiff Region",)
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    assert np.allclose(body_of(thing).young_scale ** 3, scale, rtol=1e-5)
    thing.palpate.stiff_group = ""
    assert len(status(thing).changed) == 1
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    assert body_of(thing).young_scale is None
    assert "young_scale" not in thing.palpate
    assert status(thing).changed == ()


def test_a_stiff_region_without_a_group_or_vertices_is_refused_with_a_remedy(palpate):
    thing = cube()
    thing.palpate.stiff_group = "Bone"
    assert "Stiff Region" in error_of(bpy.ops.palpate.make_soft)
    thing.vertex_groups.new(name="Bone")
    assert "assign" in error_of(bpy.ops.palpate.make_soft)
    assert not thing.palpate.body_key


@pytest.fixture
def compressed(palpate):
    """A compressed cube of some hundred free surface nodes."""
    thing = cube()
    thing.palpate.edge_length = 0.06
    thing.palpate.form, thing.palpate.compression_tolerance = "COMPRESSED", 2.0
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    return thing


def test_a_compressed_body_is_pressed_and_restored(compressed):
    assert compressed.palpate.baked_form == "compressed"
    assert 0 < compressed.palpate.column_error <= 2.0
    assert status(compressed).changed == ()
    press_down(compressed)
    key = compressed.palpate.body_key
    locate(compressed).unlink()
    press_down(compressed)
    assert body_of(compressed).compliance.form == "compressed"
    assert compressed.palpate.body_key == key


def test_elements_are_smoothed_unless_linear_ones_are_chosen(compressed):
    assert compressed.palpate.baked_formulation == body_of(compressed).formulation == "smoothed"
    assert status(compressed).changed == ()
    compressed.palpate.formulation = "LINEAR"
    assert status(compressed).changed == ("Formulation",)
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    assert body_of(compressed).formulation == "linear"
    assert status(compressed).changed == ()


@pytest.mark.at_length
def test_another_form_is_said_and_taken_over(compressed):
    key = compressed.palpate.body_key
    compressed.palpate.form = "DENSE"
    assert status(compressed).changed == ("Compliance",)
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    assert body_of(compressed).compliance.form == compressed.palpate.baked_form == "dense"
    assert compressed.palpate.body_key == key, "the form is no part of what the body is"
    compressed.palpate.form = "AUTO"
    assert status(compressed).changed == ()


@pytest.mark.at_length
def test_more_pins_of_a_compressed_body(compressed):
    compressed.palpate.pin_fraction = 0.3
    assert status(compressed).pins.fit.name in {"MORE", "OTHER"}
    if status(compressed).pins.quick:
        assert bpy.ops.palpate.update_pins() == {"FINISHED"}
        assert body_of(compressed).compliance.form == "compressed"


def test_a_prediction_follows_the_settings(palpate):
    known = part("addon.known_status")
    part("core.machine.machine_speed").dgemm_rate()
    thing, scene = cube(), bpy.context.scene
    thing.palpate.edge_length = 0.05
    before = known.prediction(thing, scene).cost
    thing.palpate.edge_length = 0.025
    finer = known.prediction(thing, scene).cost
    assert finer.nodes > 4 * before.nodes
    assert finer.seconds > before.seconds
    files = []
    for form in ("DENSE", "COMPRESSED"):
        thing.palpate.form = form
        files.append(known.prediction(thing, scene).cost.file_bytes)
    assert files[1] < files[0]
    thing.palpate.pin_fraction = 0.9
    assert known.prediction(thing, scene).cost.free_surface_nodes < finer.free_surface_nodes


@pytest.mark.parametrize("by", ["COMPRESSED", "COARSER"])
def test_a_bake_that_is_too_large_is_made_to_fit(palpate, monkeypatch, by):
    module = part("operators.bake.bake_prediction")
    thing, scene = cube(), bpy.context.scene
    part("core.machine.machine_speed").dgemm_rate()
    thing.palpate.edge_length = 0.025
    needed = {}
    for form in ("COMPRESSED", "DENSE"):
        thing.palpate.form = form
        needed[form] = part("addon.known_status").prediction(thing, scene).cost.peak_bytes
    between = (needed["COMPRESSED"] + needed["DENSE"]) // 2
    assert needed["COMPRESSED"] < between
    monkeypatch.setattr(module, "available_memory", lambda: between)
    assert not part("addon.known_status").prediction(thing, scene).fits
    assert bpy.ops.palpate.fit_memory(by=by) == {"FINISHED"}
    assert part("addon.known_status").prediction(thing, scene).fits
    assert thing.palpate.form == ("COMPRESSED" if by == "COMPRESSED" else "DENSE")
