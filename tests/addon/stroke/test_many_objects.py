"""Places under the pointer in scenes of many objects: the right one, found without a walk."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from mathutils import Vector
from soft_scene import empty, part, press_down, soft_cube

MANY = 300


@pytest.fixture
def crowd(palpate):
    """A soft cube among many small tetrahedra."""
    thing, chance = soft_cube(), np.random.default_rng(5)
    corners = 0.01 * np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
    mesh = bpy.data.meshes.new("Small")
    mesh.from_pydata(corners, [], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
    for number, place in enumerate(chance.uniform(-0.12, 0.12, (MANY, 3))):
        one = bpy.data.objects.new(f"Small {number}", mesh)
        one.location, one.rotation_euler = place, chance.uniform(0, 6, 3)
        one.scale = chance.uniform(0.5, 3.0, 3)
        bpy.context.collection.objects.link(one)
    bpy.context.view_layer.update()
    return thing


def rays(count=40):
    """Origins and unit directions of lines of sight towards the cube."""
    chance = np.random.default_rng(11)
    for _ in range(count):
        origin = chance.normal(size=3)
        origin *= 0.4 / np.linalg.norm(origin)
        along = chance.uniform(-0.02, 0.02, 3) - origin
        yield origin, along / np.linalg.norm(along)


def found_on(origin, along):
    graph = bpy.context.evaluated_depsgraph_get()
    return part("operators.place.seen_place").under_ray(bpy.context.scene, graph, origin, along)


def agree_with_blender(thing):
    """Referee: Blender's own ray through everything; returns how many rays meet the cube."""
    scene, met = bpy.context.scene, 0
    for origin, along in rays():
        graph = bpy.context.evaluated_depsgraph_get()
        hit, place, _, _, first, _ = scene.ray_cast(graph, Vector(origin), Vector(along))
        found = found_on(origin, along)
        if not hit or first.original != thing:
            assert found is None
            continue
        assert found.thing == thing
        np.testing.assert_allclose(found.seen, place, atol=1e-5)
        met += 1
    return met


def test_what_moves_is_found_and_hidden_where_it_is(crowd):
    before = agree_with_blender(crowd)
    assert 0 < before < 40
    small = bpy.data.objects["Small 3"]
    small.scale = (30.0, 30.0, 30.0)
    small.rotation_euler = (0.0, 0.0, 0.0)
    small.location = (0.03, -0.15, -0.15)
    bpy.context.view_layer.update()
    assert agree_with_blender(crowd) != before
    crowd.location.x += 0.05
    bpy.context.view_layer.update()
    agree_with_blender(crowd)
    small.hide_set(True)
    bpy.context.view_layer.update()
    agree_with_blender(crowd)
    for frame, place in ((1, 0.0), (5, 0.08)):
        crowd.location.x = place
        crowd.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_set(5)
    agree_with_blender(crowd)
    bpy.data.objects.remove(small)
    bpy.context.view_layer.update()
    agree_with_blender(crowd)


def test_instances_are_found_and_hide(crowd):
    shared = bpy.data.collections.new("Shared")
    bpy.context.scene.collection.children.link(shared)
    shared.objects.link(crowd)
    instancer = empty("Instancer", at=(0.0, 0.0, 0.0))
    instancer.instance_type, instancer.instance_collection = "COLLECTION", shared
    for place in ((0.03, 0.01, 0.0), (0.0, -0.05, 0.02)):
        instancer.location = place
        bpy.context.view_layer.update()
        assert agree_with_blender(crowd) > 0


def test_boxes_are_read_once_while_an_object_is_pressed(crowd, monkeypatch):
    meshes = part("operators.place.drawn_meshes")
    read, times = meshes._read, []

    def counted(graph):
        times.append(graph)
        return read(graph)

    press_down(crowd)
    layers = part("operators.layer.layers")
    layer, small = layers.layers_of(crowd)[0], bpy.data.objects["Small 3"]
    bpy.context.view_layer.update()
    monkeypatch.setattr(meshes, "_read", counted)
    meshes.forget()
    for depth, (origin, along) in enumerate(rays()):
        moved = np.zeros(24, dtype=np.float32)
        moved[2::3] = -1e-4 * depth
        layers.write(crowd, layer, moved)
        small.location.x = 0.001 * depth
        bpy.context.view_layer.update()
        found_on(origin, along)
    assert len(times) == 1
    # As soon as another one is shown, all are read again.
    small.hide_set(True)
    bpy.context.view_layer.update()
    found_on(origin, along)
    assert len(times) == 2


def test_undo_looks_for_live_layers_only_where_there_are_modifiers(crowd, monkeypatch):
    live, looked = part("operators.layer.live_layer"), []
    remove = live.remove
    live.hang(crowd)
    monkeypatch.setattr(live, "remove", lambda thing: (looked.append(thing), remove(thing)))
    live.remove_leftovers()
    assert looked == [crowd]
    assert live.find(crowd) is None
