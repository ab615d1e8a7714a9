"""Make Soft through its operator: what becomes a body, what is refused, and what it leaves."""

from __future__ import annotations

import time

import bmesh
import bpy
import numpy as np
import pytest
from mathutils import Matrix
from soft_scene import (
    body_of,
    cube,
    error_of,
    layer_names,
    locate,
    mesh_object,
    mesh_state,
    moved,
    part,
    press_down,
    select,
)


def test_a_cube_gets_a_body_of_its_own_size_pinned_at_the_bottom(palpate):
    thing = cube(0.05)
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    body = body_of(thing)
    assert np.allclose(np.ptp(body.mesh.nodes, axis=0), 0.05, rtol=0.02)
    assert len(body.fixed) > 0
    assert body.mesh.nodes[body.fixed, 2].max() < -0.025 + 0.1 * 0.05 + 1e-4
    assert thing.palpate.node_count == len(body.mesh.nodes)
    # The mesh stays as it is.
    assert not thing.vertex_groups


@pytest.mark.at_length
def test_suzanne_with_an_ngon_and_open_seams_becomes_soft(palpate):
    bpy.ops.mesh.primitive_monkey_add(size=0.1)
    thing = bpy.context.object
    thing.palpate.edge_length = 0.08
    form = bmesh.new()
    form.from_mesh(thing.data)
    form.faces.ensure_lookup_table()
    first = form.faces[100]
    beside = next(face for face in first.edges[0].link_faces if face != first)
    bmesh.ops.dissolve_faces(form, faces=[first, beside])
    bmesh.ops.split_edges(
        form, edges=[edge for edge in form.edges if edge.calc_face_angle(0) > 0.9]
    )
    form.to_mesh(thing.data)
    form.free()
    assert max(len(polygon.vertices) for polygon in thing.data.polygons) > 4
    before = mesh_state(thing)
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    assert mesh_state(thing) == before
    assert body_of(thing).mesh.volume > 0


@pytest.mark.parametrize(
    ("scale", "unit"),
    [
        ((2, -0.5, 1), 1.0),
        ((1,) * 3, 0.01),
        *(
            pytest.param(scale, 1.0, marks=pytest.mark.at_length)
            for scale in ((1, 1, 1), (0.5, 2.0, 1.0), (-1, 1, 1))
        ),
    ],
)
def test_a_body_is_as_large_as_it_looks_whatever_the_scale(palpate, scale, unit):
    bpy.context.scene.unit_settings.scale_length = unit
    thing = cube(0.05 / unit)
    thing.scale = scale
    thing.rotation_euler = (0.4, 0.2, 1.0)
    select(thing)
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    body = body_of(thing)
    assert np.isclose(body.mesh.volume, 0.05**3 * abs(np.prod(scale)), rtol=0.02)
    top = thing.matrix_world @ thing.data.vertices[1].co
    middle = np.array(thing.matrix_world.translation)
    assert bpy.ops.palpate.press(at=top, by=0.1 * (middle - np.array(top))) == {"FINISHED"}
    dent = moved(thing, "Press 1")
    linear = np.array(thing.matrix_world)[:3, :3]
    pushed = dent @ linear.T
    inward = 0.1 * (middle - np.array(top))
    share = pushed[1] @ inward / (inward @ inward)
    assert 0.2 < share < 1.1, "the pressed corner did not follow the finger"
    aside = np.linalg.norm(pushed[1] - share * inward) / np.linalg.norm(inward)
    assert aside < 0.6, "it went another way than the finger"


def test_shear_by_a_parent_is_carried_into_the_body(palpate):
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.collection.objects.link(parent)
    parent.matrix_world = Matrix.Diagonal((2.0, 1.0, 1.0, 1.0))
    thing = cube(0.05)
    thing.parent = parent
    thing.rotation_euler = (0.0, 0.0, 0.7)
    select(thing)
    linear = np.array(thing.matrix_world)[:3, :3]
    lengths = np.linalg.norm(linear, axis=0)
    assert abs(linear[:, 0] @ linear[:, 1]) > 0.1 * lengths[0] * lengths[1], "there is no shear"
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    assert np.isclose(body_of(thing).mesh.volume, 2 * 0.05**3, rtol=0.02)


def test_a_pin_group_holds_what_is_in_it(palpate):
    thing = cube(0.05)
    group = thing.vertex_groups.new(name="Side")
    group.add([v.index for v in thing.data.vertices if v.co.x < 0], 1.0, "REPLACE")
    thing.palpate.pin_mode, thing.palpate.pin_group = "GROUP", "Side"
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    body = body_of(thing)
    assert np.isclose(body.mesh.nodes[body.fixed, 0].min(), -0.025, atol=1e-3)
    assert body.mesh.nodes[body.fixed, 0].max() < 1e-3


def test_pin_below_makes_and_renews_the_group(palpate):
    thing = cube(0.05)
    assert bpy.ops.palpate.pin_below(fraction=0.5) == {"FINISHED"}
    group = thing.vertex_groups["Pinned"]
    assert sum(bool(v.groups) for v in thing.data.vertices) == 4
    assert bpy.ops.palpate.pin_below(fraction=1.0) == {"FINISHED"}
    assert thing.vertex_groups.keys() == [group.name]
    assert sum(bool(v.groups) for v in thing.data.vertices) == 8


SQUARE = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
NOT_SOLID = {
    "flat": (SQUARE, [(0, 1, 2, 3)], "Solidify"),
    "empty": ([], [], "nothing"),
    "no faces": (SQUARE, [], "nothing"),
    "not finite": (
        [(-1, -1, -1), (1, -1, -1), (0, 1, -1), (0, 0, float("nan"))],
        [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)],
        "finite",
    ),
}


@pytest.mark.parametrize("case", NOT_SOLID)
def test_what_cannot_be_solid_is_refused_with_a_remedy_and_stays_as_it_is(palpate, case):
    vertices, faces, word = NOT_SOLID[case]
    thing = mesh_object(vertices, faces)
    before = mesh_state(thing)
    assert word in error_of(bpy.ops.palpate.make_soft)
    assert mesh_state(thing) == before
    assert not thing.palpate.body_key
    assert not thing.vertex_groups
    assert part("operators.bake.bake_session").current() is None


def flattened(thing):
    thing.scale = (1, 0, 1)
    select(thing)


UNFIT = {
    "scale": flattened,
    "Edit Mode": lambda _: bpy.ops.object.mode_set(mode="EDIT"),
    "mesh": lambda _: bpy.ops.object.empty_add(),
}


@pytest.mark.parametrize("word", UNFIT)
def test_an_object_that_is_not_fit_for_it_is_refused_with_a_remedy(palpate, word):
    UNFIT[word](cube())
    assert word in error_of(bpy.ops.palpate.make_soft)


def test_a_fake_user_is_nobody_who_shares_the_mesh(palpate):
    thing = cube()
    thing.data.use_fake_user = True
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}


@pytest.mark.at_length
def test_a_fine_sphere_gets_a_body_of_its_own_shape(palpate):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=160, ring_count=80, radius=0.05)
    thing = bpy.context.object
    thing.palpate.edge_length = 0.1
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    surface = body_of(thing).mesh
    radius = np.linalg.norm(surface.nodes[surface.surface_nodes], axis=1)
    assert np.abs(radius - 0.05).max() < 1e-3


def test_a_linked_object_is_refused_with_a_remedy(palpate, tmp_path):
    thing = cube()
    thing.name = "Linked"
    bpy.data.libraries.write(str(tmp_path / "library.blend"), {thing})
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.objects = ["Linked"]
    bpy.context.collection.objects.link(wanted.objects[0])
    select(wanted.objects[0])
    assert "linked" in error_of(bpy.ops.palpate.make_soft)


def test_cancelling_leaves_no_process_no_file_and_no_change(palpate, tmp_path):
    thing = cube()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    thing = select(bpy.data.objects[thing.name])
    before = mesh_state(thing)
    bake = part("operators.bake.bake_session")
    session = bake.start(thing, bpy.context.scene)
    child, folder = session.job._child, session.job._folder
    assert child.poll() is None
    assert bpy.ops.palpate.cancel_bake() == {"FINISHED"}
    assert child.poll() is not None
    assert not folder.exists()
    assert [path.name for path in tmp_path.iterdir()] == ["scene.blend"]
    assert mesh_state(thing) == before
    assert not thing.palpate.body_key
    assert not thing.vertex_groups
    assert bake.current() is None


def test_an_object_edited_or_deleted_during_the_bake_gets_no_body(palpate):
    error = part("core.errors").PalpateError
    bake = part("operators.bake.bake_session")
    thing = cube()
    session = bake.start(thing, bpy.context.scene)
    thing.data.vertices[0].co.x += 0.01
    while not session.poll():
        time.sleep(0.02)
    with pytest.raises(error, match="edited"):
        session.commit()
    assert not thing.palpate.body_key
    session = bake.start(thing, bpy.context.scene)
    bpy.data.objects.remove(thing)
    while not session.poll():
        time.sleep(0.02)
    with pytest.raises(error, match="deleted"):
        session.commit()
    assert bake.current() is None


def test_opening_another_file_ends_the_bake(palpate):
    bake = part("operators.bake.bake_session")
    session = bake.start(cube(), bpy.context.scene)
    child = session.job._child
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    assert child.poll() is not None
    assert bake.current() is None


def test_remove_softness_takes_the_body_and_leaves_the_shapes(palpate, thing):
    press_down(thing)
    path = locate(thing)
    assert path.is_file()
    assert bpy.ops.palpate.remove_softness() == {"FINISHED"}
    assert not path.exists()
    assert not thing.palpate.body_key
    assert "nodes" not in thing.palpate
    assert layer_names(thing) == ["Press 1"]


def test_a_preset_sets_the_material(palpate):
    thing = cube()
    thing.palpate.material = "RUBBER"
    assert np.isclose(thing.palpate.young_modulus, 2.2e6)
    assert np.isclose(thing.palpate.poisson_ratio, 0.49)
    assert thing.palpate.material == "RUBBER"
    thing.palpate.young_modulus *= 2
    assert thing.palpate.material == "CUSTOM"
    assert np.isclose(thing.palpate.young_modulus, 4.4e6)


def weights_of(thing, name):
    group = thing.vertex_groups[name].index
    return part("operators.scene.drawn_surface").group_weights(thing.data, group).tolist()


def test_what_a_user_painted_stays_as_it_is(palpate):
    thing = cube()
    painted = thing.vertex_groups.new(name="Pinned")
    painted.add([7], 1.0, "REPLACE")
    painted.add([6], 0.25, "REPLACE")
    before = weights_of(thing, "Pinned")
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    assert thing.vertex_groups.keys() == ["Pinned"]
    assert weights_of(thing, "Pinned") == before
    assert bpy.ops.palpate.pin_below(fraction=0.1) == {"FINISHED"}
    assert weights_of(thing, "Pinned") == before
    assert thing.palpate.pin_group == "Pinned.001"
    assert sum(weights_of(thing, "Pinned.001")) == 4.0
    # Some of a level bottom is no height.
    only = thing.vertex_groups["Pinned"]
    only.remove(range(8))
    bottom = [one.index for one in thing.data.vertices if one.co.z < 0.0]
    only.add(bottom[:2], 1.0, "REPLACE")
    assert bpy.ops.palpate.pin_below(fraction=0.1) == {"FINISHED"}
    assert sum(weights_of(thing, "Pinned")) == 2.0


def test_a_bake_waits_until_its_scene_is_shown_again(palpate):
    bake, thing, scene = part("operators.bake.bake_session"), cube(), bpy.context.scene
    thing.palpate.bake_from = "AUTO"
    thing.modifiers.new("Round", "BEVEL").width = 0.005
    session = bake.start(thing, scene)
    other = bpy.data.scenes.new("Other")
    while not session.poll():
        time.sleep(0.02)
    assert session.can_commit
    bpy.context.window.scene = other
    assert session.awaits_scene
    assert not session.can_commit
    bpy.context.window.scene = scene
    thing.hide_viewport = True
    bpy.context.view_layer.update()
    assert session.awaits_scene
    thing.hide_viewport = False
    bpy.context.view_layer.update()
    assert session.can_commit
    session.commit()
    assert thing.palpate.body_key
    assert thing.palpate.carrier is not None


def test_a_bake_whose_scene_is_deleted_ends(palpate):
    bake, thing, scene = part("operators.bake.bake_session"), cube(), bpy.context.scene
    session = bake.start(thing, scene)
    bpy.data.scenes.new("Other")
    while not session.poll():
        time.sleep(0.02)
    bpy.data.scenes.remove(scene)
    with pytest.raises(part("core.errors").PalpateError, match="deleted"):
        session.commit()
    assert bake.current() is None
