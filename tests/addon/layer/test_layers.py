"""Layers, by what Blender itself evaluates of them."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import (
    begin,
    cube,
    error_of,
    key_names,
    layer_names,
    mesh_state,
    moved,
    part,
    pose_by_bone,
    press_down,
    press_in,
    rest_places,
    seen_places,
    select,
    soft_cube,
)
from without_palpate import without_palpate


@pytest.fixture
def layers(palpate):
    return part("operators.layer.layers")


def two_presses(thing):
    press_down(thing)
    assert bpy.ops.palpate.press(at=(0.02, 0.0, 0.025), by=(0.0, 0.001, -0.004)) == {"FINISHED"}


def test_what_is_seen_is_the_mesh_and_the_sum_of_its_layers(layers, thing):
    mesh = mesh_state(thing)["mesh"]
    two_presses(thing)
    first, second = moved(thing, "Press 1"), moved(thing, "Press 2")
    assert first[:, 2].min() < -1e-4
    assert np.abs(first - second).max() > 1e-4
    np.testing.assert_allclose(seen_places(thing), rest_places(thing) + first + second, atol=1e-6)
    layers.set_strength(thing, thing.modifiers["Press 1"], 0.5)
    half = rest_places(thing) + 0.5 * first + second
    np.testing.assert_allclose(seen_places(thing), half, rtol=0, atol=1e-6)
    thing.modifiers.move(1, 0)
    np.testing.assert_allclose(seen_places(thing), half, rtol=0, atol=1e-6)
    assert mesh_state(thing)["mesh"] == mesh
    assert thing.data.shape_keys is None


def test_a_strength_is_keyed_and_driven(layers, thing):
    press_down(thing)
    layer = thing.modifiers["Press 1"]
    scene, path = bpy.context.scene, layers.strength_path(layer)
    for frame, factor in ((1, 0.0), (11, 2.0)):
        layers.set_strength(thing, layer, factor)
        thing.keyframe_insert(path, frame=frame)
    dent = moved(thing, "Press 1")
    for frame, factor in ((1, 0.0), (6, 1.0), (11, 2.0)):
        scene.frame_set(frame)
        expected = rest_places(thing) + factor * dent
        np.testing.assert_allclose(seen_places(thing), expected, rtol=0, atol=1e-6)
    assert "is animated" in error_of(bpy.ops.palpate.convert_layers)


def test_a_file_with_layers_is_seen_the_same_without_palpate(thing, tmp_path):
    two_presses(thing)
    seen = seen_places(thing)
    assert np.abs(seen - rest_places(thing)).max() > 1e-4
    opened = without_palpate(tmp_path)
    np.testing.assert_allclose(opened[thing.name], seen, rtol=0, atol=1e-6)


def test_a_pose_turns_a_layer_with_the_mesh(thing):
    press_down(thing)
    armature = pose_by_bone(thing, 1.2)
    assert bpy.ops.palpate.press(at=(0.02, 0.0, 0.025), by=(0.0, 0.0, -0.004)) == {"FINISHED"}
    assert thing.modifiers.keys() == ["Press 1", "Press 2", "Pose"]
    turn = np.array(armature.pose.bones["Bone"].matrix_channel)[:3, :3]
    dented = rest_places(thing) + moved(thing, "Press 1") + moved(thing, "Press 2")
    assert np.abs(turn - np.eye(3)).max() > 0.5
    np.testing.assert_allclose(seen_places(thing), dented @ turn.T, rtol=0, atol=1e-6)


def test_objects_that_share_a_mesh_have_their_own_layers(palpate):
    thing = soft_cube()
    twin = thing.copy()
    bpy.context.collection.objects.link(twin)
    twin.location.x = 0.2
    bpy.context.view_layer.update()
    press_down(thing)
    np.testing.assert_array_equal(seen_places(twin), rest_places(twin))
    select(twin)
    assert bpy.ops.palpate.press(at=(0.2, 0.0, -0.02), by=(0.0, 0.0, 0.004)) == {"FINISHED"}
    assert (layer_names(thing), layer_names(twin)) == (["Press 1"], ["Press 2"])
    for one, name in ((thing, "Press 1"), (twin, "Press 2")):
        expected = rest_places(one) + moved(one, name)
        np.testing.assert_allclose(seen_places(one), expected, rtol=0, atol=1e-6)
    assert "Single User" in str(error_of(bpy.ops.palpate.apply_layers))


def test_a_duplicate_keeps_its_dent_when_the_first_one_loses_it(layers, thing):
    press_down(thing)
    twin = thing.copy()
    bpy.context.collection.objects.link(twin)
    dented = seen_places(thing)
    layers.remove(thing, thing.modifiers["Press 1"])
    np.testing.assert_array_equal(seen_places(thing), rest_places(thing))
    np.testing.assert_array_equal(seen_places(twin), dented)
    layers.remove(twin, twin.modifiers["Press 1"])
    assert "Press 1" not in thing.data.attributes


def test_names_that_are_taken_are_not_given_again(thing):
    thing.shape_key_add(name="Basis")
    thing.shape_key_add(name="Press 1")
    thing.vertex_groups.new(name="Press 2")
    press_down(thing)
    assert layer_names(thing) == ["Press 3"]
    # Kept by an older Palpate: it stays as it is.
    assert thing.data.shape_keys.key_blocks.keys() == ["Basis", "Press 1"]


@pytest.mark.parametrize("with_keys", [False, True])
def test_converted_layers_are_shape_keys_that_look_the_same(layers, thing, with_keys):
    if with_keys:
        thing.shape_key_add(name="Basis")
        other = thing.shape_key_add(name="Other")
        other.points[0].co.x += 0.01
        other.value = 0.5
    two_presses(thing)
    layers.set_strength(thing, thing.modifiers["Press 2"], 1.5)
    seen = seen_places(thing)
    assert bpy.ops.palpate.convert_layers() == {"FINISHED"}
    assert not thing.modifiers
    assert not any(one.name.startswith("Press") for one in thing.data.attributes)
    keys = thing.data.shape_keys.key_blocks
    assert keys.keys() == (["Basis", "Other"] if with_keys else ["Basis"]) + ["Press 1", "Press 2"]
    assert keys["Press 2"].value == pytest.approx(1.5)
    np.testing.assert_allclose(seen_places(thing), seen, rtol=0, atol=1e-6)


@pytest.mark.parametrize("with_keys", [False, True])
def test_applied_layers_are_in_the_mesh_and_hidden_ones_stay(layers, thing, with_keys):
    if with_keys:
        thing.shape_key_add(name="Basis")
        thing.shape_key_add(name="Other").value = 0.5
    two_presses(thing)
    layers.set_strength(thing, thing.modifiers["Press 1"], -0.5)
    thing.modifiers["Press 2"].show_viewport = False
    seen = seen_places(thing)
    assert bpy.ops.palpate.apply_layers() == {"FINISHED"}
    assert layer_names(thing) == ["Press 2"]
    np.testing.assert_allclose(seen_places(thing), seen, rtol=0, atol=1e-6)
    np.testing.assert_allclose(rest_places(thing), seen, rtol=0, atol=1e-6)
    assert "Make Soft" in error_of(bpy.ops.palpate.press, at=(0, 0, 0.02), by=(0, 0, -0.01))


def test_without_layers_there_is_nothing_to_convert(palpate):
    cube()
    assert not bpy.ops.palpate.convert_layers.poll()
    assert not bpy.ops.palpate.apply_layers.poll()


def test_a_live_layer_in_a_file_is_removed(thing, before, tmp_path):
    """As from an autosave, which Blender writes without telling."""
    live = part("operators.layer.live_layer")
    live.hang(thing)
    live.write(thing, np.ones(3 * len(thing.data.vertices), dtype=np.float32))
    assert mesh_state(thing) != before
    name = thing.name
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "autosaved.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "autosaved.blend"))
    assert mesh_state(bpy.data.objects[name]) == before


def test_a_live_layer_that_the_user_removes_ends_the_press(sessions, states, thing, before):
    session = begin(sessions, states, thing)
    press_in(session, states)
    thing.modifiers.remove(thing.modifiers["Palpate Live"])
    session.tick()
    assert sessions.current() is None
    assert "lost its live layer" in session.state.message
    assert mesh_state(thing) == before


def test_a_stranger_s_group_of_the_same_name_is_left_alone(palpate):
    stranger = bpy.data.node_groups.new("Palpate Layer", "GeometryNodeTree")
    stranger["palpate_group"] = "layer 1"
    thing = soft_cube()
    press_down(thing)
    assert thing.modifiers["Press 1"].node_group != stranger
    assert not stranger.nodes
    dented = rest_places(thing) + moved(thing, "Press 1")
    np.testing.assert_allclose(seen_places(thing), dented, rtol=0, atol=1e-6)


def test_layers_are_not_converted_for_all_that_share_a_mesh(thing):
    press_down(thing)
    twin = thing.copy()
    bpy.context.collection.objects.link(twin)
    dented = seen_places(twin)
    assert "Single User" in error_of(bpy.ops.palpate.convert_layers)
    np.testing.assert_array_equal(seen_places(twin), dented)
    bpy.ops.object.make_single_user(object=True, obdata=True)
    assert bpy.ops.palpate.convert_layers() == {"FINISHED"}


@pytest.mark.parametrize("act", ["convert_layers", "apply_layers", "animate_layers"])
def test_what_pressers_write_is_no_kept_dent(layers, thing, act):
    layer = layers.add(thing, name := layers.PRESSERS_NAME)
    layers.write(thing, layer, np.full(3 * len(thing.data.vertices), 0.01, dtype=np.float32))
    assert not getattr(bpy.ops.palpate, act).poll()
    press_down(thing)
    assert getattr(bpy.ops.palpate, act)() == {"FINISHED"}
    assert name in layer_names(thing)
    assert layers.strength(thing.modifiers[name]) == 1.0
    path = layers.strength_path(thing.modifiers[name])
    assert not part("operators.scene.curves").is_animated(thing, path)
    assert name not in key_names(thing)
