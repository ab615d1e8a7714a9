"""Copies of soft objects: instances, linked duplicates, objects of other files."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import (
    error_of,
    layer_names,
    moved,
    part,
    press_down,
    rest_places,
    seen_places,
    select,
    soft_cube,
)

DOWN = (np.array([0.004, 0.003, 1.0]), np.array([0.0, 0.0, -1.0]))


def under_ray(origin, direction):
    bpy.context.view_layer.update()
    graph = bpy.context.evaluated_depsgraph_get()
    found = part("operators.place.seen_place").under_ray(
        bpy.context.scene, graph, origin, direction
    )
    touched = part("operators.place.touched_place").touched(found, origin, direction)
    return found, touched


def instance_of(thing, offset):
    """An instance of the collection that a soft object is in; that object alone in it."""
    group = bpy.data.collections.new("Group")
    bpy.context.scene.collection.children.link(group)
    for user in thing.users_collection:
        user.objects.unlink(thing)
    group.objects.link(thing)
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    made = bpy.data.objects.new("Instance", None)
    made.instance_type, made.instance_collection = "COLLECTION", group
    made.location = offset
    made.rotation_euler.z = 1.0
    bpy.context.scene.collection.objects.link(made)
    return made


def test_an_instance_of_a_collection_is_touched_where_it_is_seen(palpate):
    thing = soft_cube()
    made = instance_of(thing, (0.3, 0.2, 0.1))
    bpy.context.view_layer.update()
    matrix = np.array(made.matrix_world)
    rest = np.array([0.004, 0.003, 0.025])
    seen = matrix[:3, :3] @ rest + matrix[:3, 3]
    found, touched = under_ray(seen - DOWN[1], DOWN[1])
    assert found.thing == thing
    np.testing.assert_allclose(found.seen, seen, atol=1e-6)
    np.testing.assert_allclose(touched.rest, rest, atol=1e-6)
    # All instances show its layers.
    press_down(thing)
    dented, _ = under_ray(matrix[:3, 3] - DOWN[1], DOWN[1])
    assert dented.thing == thing


def test_what_is_seen_as_an_instance_alone_is_told(palpate):
    thing = soft_cube()
    instance_of(thing, (0.0, 0.0, 0.0))
    group = bpy.data.collections["Group"]
    bpy.context.scene.collection.children.unlink(group)
    with pytest.raises(part("core.errors").PalpateError, match="instance alone"):
        under_ray(*DOWN)


def geometry_group(realize):
    """Geometry nodes that make an instance of the moved mesh, realized or not, beside it."""
    group = bpy.data.node_groups.new("Aside", "GeometryNodeTree")
    for in_out in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    nodes, links = group.nodes, group.links
    given, result = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
    instance, move = nodes.new("GeometryNodeGeometryToInstance"), nodes.new("GeometryNodeTransform")
    move.inputs["Translation"].default_value = (0.2, 0.0, 0.0)
    join = nodes.new("GeometryNodeJoinGeometry")
    links.new(given.outputs[0], move.inputs[0])
    links.new(move.outputs[0], instance.inputs[0])
    links.new(instance.outputs[0], join.inputs[0])
    links.new(given.outputs[0], join.inputs[0])
    last = join
    if realize:
        last = nodes.new("GeometryNodeRealizeInstances")
        links.new(join.outputs[0], last.inputs[0])
    links.new(last.outputs[0], result.inputs[0])
    return group


@pytest.mark.parametrize("realize", [True, False])
def test_instances_of_geometry_nodes_are_soft_once_they_are_realized(palpate, realize):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.ops.mesh.primitive_cube_add(size=0.05)
    thing = bpy.context.object
    thing.palpate.edge_length = 0.2
    thing.modifiers.new("Aside", "NODES").node_group = geometry_group(realize)
    select(thing)
    if realize:
        assert bpy.ops.palpate.make_soft() == {"FINISHED"}
        assert bpy.ops.palpate.stroke(place=(0.2, 0.0, 0.025), depth=0.003) == {"FINISHED"}
        rest, dent = rest_places(thing.palpate.carrier), moved(thing, "Press 1")
        assert rest[np.argmax(np.abs(dent).max(axis=1)), 0] > 0.15
        return
    thing.palpate.bake_from = "BASE"
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    marked = part("operators.layer.place_marks").marked(thing)
    with marked, pytest.raises(part("core.errors").PalpateError, match="Realize Instances"):
        under_ray(DOWN[0] + [0.2, 0.0, 0.0], DOWN[1])


def test_a_mesh_that_becomes_instances_alone_is_refused(palpate):
    thing = select(bpy.data.objects["Cube"])
    group = bpy.data.node_groups.new("All", "GeometryNodeTree")
    for in_out in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    given, result = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    instance = group.nodes.new("GeometryNodeGeometryToInstance")
    group.links.new(given.outputs[0], instance.inputs[0])
    group.links.new(instance.outputs[0], result.inputs[0])
    thing.modifiers.new("All", "NODES").node_group = group
    assert "Realize Instances" in error_of(bpy.ops.palpate.make_soft)


def test_a_linked_duplicate_shares_the_carrier_and_has_layers_of_its_own(palpate):
    thing = select(bpy.data.objects["Cube"])
    thing.palpate.edge_length = 0.2
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    twin = thing.copy()
    bpy.context.collection.objects.link(twin)
    twin.location.x = 5.0
    bpy.context.view_layer.update()
    for one, place in ((thing, (0.1, 0.2, 1.0)), (twin, (5.5, -0.2, 1.0))):
        select(one)
        assert bpy.ops.palpate.stroke(place=place, depth=0.1, radius=0.2) == {"FINISHED"}
    assert (layer_names(thing), layer_names(twin)) == (["Press 1"], ["Press 2"])
    rest = rest_places(thing.palpate.carrier)
    for one in (thing, twin):
        expected = rest + moved(one, layer_names(one)[0])
        np.testing.assert_allclose(seen_places(one), expected, atol=1e-6)
    layers = part("operators.layer.layers")
    layers.remove(thing, thing.modifiers["Press 1"])
    assert (len(seen_places(thing)), len(seen_places(twin))) == (8, len(rest))


@pytest.mark.parametrize("override", [False, pytest.param(True, marks=pytest.mark.at_length)])
def test_an_object_of_another_file_is_refused_and_keeps_its_dents(palpate, tmp_path, override):
    thing = select(bpy.data.objects["Cube"])
    thing.palpate.edge_length = 0.2
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    assert bpy.ops.palpate.stroke(place=(0.1, 0.2, 1.0), depth=0.1, radius=0.2) == {"FINISHED"}
    dented, file = seen_places(thing), str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(file, link=True) as (_, there):
        there.objects = ["Cube"]
    (linked,) = there.objects
    bpy.context.scene.collection.objects.link(linked)
    if override:
        bpy.context.scene.collection.objects.unlink(linked)
        linked = linked.override_create(remap_local_usages=True)
        bpy.context.scene.collection.objects.link(linked)
    select(linked)
    # What is linked shows its dents, and says why it cannot be pressed.
    np.testing.assert_allclose(seen_places(linked), dented, atol=1e-6)
    assert "make it local" in str(part("operators.object.soft_object").refusal(linked))


@pytest.mark.at_length
def test_an_appended_object_brings_its_carrier_but_not_into_the_scene(palpate, tmp_path):
    thing = select(bpy.data.objects["Cube"])
    thing.palpate.edge_length = 0.2
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    assert bpy.ops.palpate.stroke(place=(0.1, 0.2, 1.0), depth=0.1, radius=0.2) == {"FINISHED"}
    dented, file = seen_places(thing), tmp_path / "given.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.wm.append(filename="Cube", directory=f"{file}/Object/")
    assert bpy.context.scene.objects.keys() == ["Cube"]
    appended = bpy.data.objects["Cube"]
    on = appended.palpate.carrier
    assert (on.users_collection, on.hide_render) == ((), True)
    np.testing.assert_allclose(seen_places(appended), dented, atol=1e-6)
