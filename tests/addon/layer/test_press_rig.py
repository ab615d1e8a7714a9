"""Press rigs: sliders that add stored answers, exactly."""

from __future__ import annotations

import bpy
import numpy as np
from soft_scene import mesh_state, part, rest_places, seen_places
from without_palpate import without_palpate

AT = (0.004, 0.002, 0.025)


def set_sliders(thing, rig, values):
    inputs = part("operators.layer.modifier_inputs")
    for axis, value in zip("XYZ", values, strict=True):
        inputs.set_value(rig, axis, value)
    thing.update_tag()


def test_sliders_superpose_the_three_answers(thing, tmp_path):
    mesh = mesh_state(thing)["mesh"]
    assert bpy.ops.palpate.add_press_rig(use_cursor=False, at=AT, radius=0.1) == {"FINISHED"}
    (rig,) = part("operators.layer.press_rig").rigs_of(thing)
    rest = rest_places(thing)
    np.testing.assert_array_equal(seen_places(thing), rest)
    units = []
    for unit in np.eye(3):
        set_sliders(thing, rig, unit)
        units.append(seen_places(thing) - rest)
    assert all(np.abs(one).max() > 1e-4 for one in units)
    values = np.array([0.5, -1.25, 2.0])
    set_sliders(thing, rig, values)
    together = rest + np.tensordot(values, np.array(units), axes=1)
    np.testing.assert_allclose(seen_places(thing), together, rtol=0, atol=1e-6)
    np.testing.assert_allclose(
        without_palpate(tmp_path)[thing.name], seen_places(thing), rtol=0, atol=1e-6
    )
    assert mesh_state(thing)["mesh"] == mesh


def test_a_slider_moves_the_place_by_the_radius_and_is_what_the_body_answers(thing):
    scene = bpy.context.scene
    drawn = part("operators.object.drawn_body").open_body(thing, scene)
    place = part("core.contact.place").nearest_place(drawn.body, np.array(AT))
    corners = drawn.body.mesh.surface_triangles[place.triangle]
    grip = part("core.grip.patch").Grip(place.triangle, place.alpha, -place.axis, 0.005)
    normals = drawn.node_normals[drawn.body.mesh.surface_nodes]
    held = part("core.grip.held_patch").HeldPatch.of(drawn.body, [grip], normals)
    everywhere = drawn.node_displacements(held.displacements[:, :, 2] * 0.005)
    np.testing.assert_allclose(place.alpha @ everywhere[corners], [0, 0, 0.005], atol=1e-3)
    made = part("operators.press.add_press_rig").answers(drawn, np.array(AT), 0.005)
    expected = drawn.drawn_displacement(held.displacements[:, :, 2] * 0.005)
    np.testing.assert_allclose(made[2].ravel(), expected, rtol=0, atol=1e-5)


def test_a_rig_is_taken_back_with_its_animation_and_attributes(thing):
    before = mesh_state(thing)
    assert bpy.ops.palpate.add_press_rig(use_cursor=False, at=AT, radius=0.1) == {"FINISHED"}
    (rig,) = part("operators.layer.press_rig").rigs_of(thing)
    inputs, curves = part("operators.layer.modifier_inputs"), part("operators.scene.curves")
    paths = [inputs.path(rig, axis) for axis in "XY"]
    for path in paths:
        thing.keyframe_insert(path)
    assert bpy.ops.palpate.remove_layer(layer=rig.name) == {"FINISHED"}
    assert mesh_state(thing) == before
    assert not any(curves.is_animated(thing, path) for path in paths)


def test_a_rig_after_one_that_was_deleted_by_hand_has_its_own_answers(thing):
    first, second = (np.random.default_rng(seed).random((3, 8, 3), np.float32) for seed in (1, 2))
    rigs = part("operators.layer.press_rig")
    thing.modifiers.remove(rigs.add(thing, first))
    rig = rigs.add(thing, second)
    rest = rest_places(thing)
    set_sliders(thing, rig, (0.0, 1.0, 0.0))
    np.testing.assert_allclose(seen_places(thing), rest + second[1], rtol=0, atol=1e-6)
