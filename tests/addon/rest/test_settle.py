"""Objects that nobody holds come to rest, and are brought back."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix
from soft_scene import (
    body_of,
    error_of,
    layer_names,
    mesh_state,
    part,
    rest_places,
    seen_places,
    select,
    status,
)

EDGE = 0.05


def world_places(thing):
    """Drawn vertices as seen, world coordinates."""
    bpy.context.view_layer.update()
    matrix = np.array(thing.matrix_world)
    return seen_places(thing) @ matrix[:3, :3].T + matrix[:3, 3]


def weight_of(thing):
    return thing.palpate.density * body_of(thing).inertia.volume * 9.81


def test_an_object_settles_on_the_ground_and_is_brought_back(free_cube):
    free_cube.location.z = 0.03
    bpy.context.view_layer.update()
    before, place = mesh_state(free_cube), free_cube.matrix_world.copy()
    assert bpy.ops.palpate.settle() == {"FINISHED"}
    assert layer_names(free_cube) == ["Rests"]
    assert 0.0245 < free_cube.location.z < 0.025
    low = world_places(free_cube)[:, 2].min()
    assert low == pytest.approx(0.0, abs=2e-6)
    sag = seen_places(free_cube) - rest_places(free_cube)
    assert 1e-5 < np.abs(sag).max() < 2e-3
    assert bpy.ops.palpate.reset_rest() == {"FINISHED"}
    assert free_cube.matrix_world == place
    assert mesh_state(free_cube) == before


def test_what_rests_already_stays_there(free_cube):
    bpy.ops.palpate.settle()
    once, first = world_places(free_cube), free_cube.matrix_world.copy()
    bpy.ops.palpate.settle()
    # Friction of the way down is not remembered: what bulged at the foot may slip a little.
    np.testing.assert_allclose(world_places(free_cube), once, rtol=0, atol=3e-4)
    np.testing.assert_allclose(free_cube.matrix_world, first, rtol=0, atol=1e-3)


def test_the_floor_bears_the_weight(free_cube):
    settle = part("operators.rest.settle").settle
    (lying,) = settle([free_cube], bpy.context.evaluated_depsgraph_get())
    (floor,) = lying.rest.supports
    np.testing.assert_allclose(floor.force, (0.0, 0.0, -weight_of(free_cube)), rtol=1e-6, atol=1e-7)


def test_a_heavier_one_sags_more_without_a_bake(free_cube):
    bpy.ops.palpate.settle()
    light = np.abs(seen_places(free_cube) - rest_places(free_cube)).max()
    bpy.ops.palpate.reset_rest()
    free_cube.palpate.density *= 3.0
    assert status(free_cube).fit.name == "READY"
    bpy.ops.palpate.settle()
    heavy = np.abs(seen_places(free_cube) - rest_places(free_cube)).max()
    assert heavy == pytest.approx(3.0 * light, rel=0.3)


def test_a_floor_at_a_height_and_one_that_is_leant(free_cube, board):
    free_cube.palpate.floor, free_cube.palpate.floor_height = "HEIGHT", -0.1
    bpy.ops.palpate.settle()
    assert free_cube.location.z == pytest.approx(-0.075, abs=5e-4)
    bpy.ops.palpate.reset_rest()
    # The board is above the floor, and bears it.
    free_cube.location.z = 0.03
    board(at=(0.0, 0.0, 0.0))
    bpy.ops.palpate.settle()
    assert free_cube.location.z == pytest.approx(0.025, abs=5e-4)


def test_what_is_drawn_ends_where_a_collider_begins(free_cube, board):
    free_cube.palpate.floor = "NONE"
    free_cube.palpate.density *= 10.0
    free_cube.location.z = 0.03
    board()
    bpy.ops.palpate.settle()
    drawn = world_places(free_cube)
    assert drawn[:, 2].min() == pytest.approx(0.0, abs=2e-6)
    lying = part("operators.rest.settle").settle(
        [free_cube], bpy.context.evaluated_depsgraph_get()
    )[0]
    # By its elements alone it would end in it.
    body = lying.rest.body
    moved = lying.rest.displacements()
    nodes = lying.rest.to_world(body.mesh.nodes[body.compliance.free_surface] + moved)
    assert nodes[:, 2].min() < -1e-4


@pytest.mark.parametrize(("degrees", "stays"), [(15.0, True), (40.0, False)])
def test_friction_holds_it_on_a_slope(free_cube, board, degrees, stays):
    turn = Matrix.Rotation(np.radians(degrees), 4, "Y")
    board(turn=turn)
    free_cube.matrix_world = turn @ Matrix.Translation((0.0, 0.0, 0.0252))
    free_cube.palpate.floor = "NONE"
    bpy.context.view_layer.update()
    before = np.array(free_cube.location)
    if stays:
        bpy.ops.palpate.settle()
        assert np.linalg.norm(np.array(free_cube.location) - before) < 2e-3
    else:
        assert "still moves" in error_of(bpy.ops.palpate.settle)
        np.testing.assert_array_equal(free_cube.location, before)
        assert layer_names(free_cube) == []


def test_a_flat_collider_is_a_slab_and_an_open_hollow_one_is_refused(free_cube, colliders):
    free_cube.palpate.floor = "NONE"
    free_cube.location.z = 0.03
    bpy.ops.mesh.primitive_plane_add(size=0.4)
    colliders.objects.link(bpy.context.object)
    select(free_cube)
    bpy.ops.palpate.settle()
    assert free_cube.location.z == pytest.approx(0.025, abs=5e-4)
    bpy.ops.mesh.primitive_torus_add(location=(5.0, 0.0, 0.0))
    torus = bpy.context.object
    torus.data.update()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    torus.data.polygons[0].select = True
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.delete(type="FACE")
    bpy.ops.object.mode_set(mode="OBJECT")
    colliders.objects.link(torus)
    select(free_cube)
    message = error_of(bpy.ops.palpate.settle)
    assert torus.name in message
    assert "Solidify" in message


def test_a_hollow_collider_bears_within_its_hollow(free_cube, colliders):
    """A trough of one closed mesh: floor 20 mm, walls 100 mm apart and 80 mm high."""
    outline = [(-70, 0), (70, 0), (70, 80), (50, 80), (50, 20), (-50, 20), (-50, 80), (-70, 80)]
    corners = [(x / 1e3, y / 1e3, z / 1e3) for y in (-80, 80) for x, z in outline]
    sides = [(k, (k + 1) % 8, (k + 1) % 8 + 8, k + 8) for k in range(8)]
    mesh = bpy.data.meshes.new("Trough")
    mesh.from_pydata(corners, [], [tuple(range(7, -1, -1)), tuple(range(8, 16)), *sides])
    trough = bpy.data.objects.new("Trough", mesh)
    bpy.context.collection.objects.link(trough)
    colliders.objects.link(trough)
    select(free_cube)
    free_cube.palpate.floor = "NONE"
    free_cube.location.z = 0.05
    bpy.context.view_layer.update()
    assert bpy.ops.palpate.settle() == {"FINISHED"}
    assert free_cube.location.z == pytest.approx(0.045, abs=1e-3)


def test_what_cannot_lie_by_itself_is_refused_with_the_remedy(free_cube, thing):
    select(thing)
    assert "Pins: None" in error_of(bpy.ops.palpate.settle)
    select(free_cube)
    free_cube.palpate.floor = "NONE"
    assert "Rests On" in error_of(bpy.ops.palpate.settle)
    free_cube.palpate.floor = "UNDER"
    free_cube.parent = thing
    assert "parent" in error_of(bpy.ops.palpate.settle)


def test_one_that_would_sink_into_a_heap_is_told_so_and_stays(free_cube):
    free_cube.palpate.density, free_cube.palpate.young_modulus = 100.0, 90.0
    before, place = mesh_state(free_cube), free_cube.matrix_world.copy()
    assert "is too soft for its size" in error_of(bpy.ops.palpate.settle)
    assert mesh_state(free_cube) == before
    assert free_cube.matrix_world == place
    free_cube.palpate.young_modulus = 400.0
    assert bpy.ops.palpate.settle() == {"FINISHED"}


def test_a_turned_object_tips_onto_a_face_and_keeps_its_scale(free_cube):
    turn = Euler((0.2, 0.1, 0.3))
    free_cube.matrix_world = Matrix.LocRotScale((0.1, 0.2, 0.06), turn, (1.0, 1.0, 1.0))
    bpy.context.view_layer.update()
    scale = tuple(free_cube.scale)
    bpy.ops.palpate.settle()
    np.testing.assert_array_equal(free_cube.scale, scale)
    places = world_places(free_cube)
    assert places[:, 2].min() == pytest.approx(0.0, abs=2e-6)
    assert places[:, 2].max() == pytest.approx(EDGE, abs=1e-3)


def test_pins_can_be_given_later_and_taken_away(free_cube):
    free_cube.palpate.pin_mode = "BELOW"
    assert status(free_cube).pins.quick
    assert bpy.ops.palpate.update_pins() == {"FINISHED"}
    assert bpy.ops.palpate.press(at=(0.0, 0.0, 0.025), by=(0.0, 0.0, -0.002)) == {"FINISHED"}
    free_cube.palpate.pin_mode = "NONE"
    assert bpy.ops.palpate.update_pins() == {"FINISHED"}
    assert bpy.ops.palpate.settle() == {"FINISHED"}


@pytest.mark.parametrize("name", ["read_durometer", "map_softness", "force_curve"])
def test_what_needs_a_hand_says_so_and_leaves_nothing(free_cube, name):
    bpy.context.scene.palpate.tip = "SPHERE"
    before = mesh_state(free_cube)
    message = error_of(getattr(bpy.ops.palpate, name))
    assert "nothing holds it" in message
    assert "Steady" in message
    assert mesh_state(free_cube) == before


def test_with_a_hand_its_softness_is_read(free_cube):
    """That of a thick block is hardly another where its foot is held."""
    scene = bpy.context.scene
    scene.palpate.tip, free_cube.palpate.young_modulus = "SPHERE", 1e5
    found = []
    for pins, steady in (("NONE", True), ("BELOW", False)):
        free_cube.palpate.pin_mode, free_cube.palpate.steady = pins, steady
        if pins == "BELOW":
            assert bpy.ops.palpate.update_pins() == {"FINISHED"}
        assert bpy.ops.palpate.read_durometer(at=(0.002, 0.001, 0.025)) == {"FINISHED"}
        found.append(free_cube.palpate_softness.read_value)
    assert found[0] == pytest.approx(found[1], rel=0.05)
    assert found[0] > 0.0
