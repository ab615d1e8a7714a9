"""What is drawn over the object to look into it, in numbers; and what is wrong with a mesh."""

from __future__ import annotations

from types import SimpleNamespace

import bmesh
import bpy
import numpy as np
import pytest
from recorded_layout import drawn
from soft_scene import cube, error_of, mesh_object, part, select, soft_cube


def areas(faces):
    return 0.5 * np.linalg.norm(
        np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), axis=1
    )


@pytest.mark.parametrize("fraction", [0.0, 0.1, 0.37, 0.95])
def test_the_film_covers_the_pinned_part_of_a_cube_exactly(palpate, fraction):
    thing = cube(2.0)
    thing.palpate.pin_fraction = fraction
    faces, _ = part("addon.inspection.body_view")._pins(bpy.context)
    assert areas(faces).sum() == pytest.approx(4.0 + 16.0 * fraction, rel=1e-3)
    assert faces[..., 2].max() == pytest.approx(-1.0 + 2.0 * fraction, abs=1e-3)
    across = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    assert (np.einsum("fx,fx->f", across, faces.mean(axis=1)) > -1e-9).all()


def test_a_cut_body_shows_what_is_left_of_it_wound_outward(palpate):
    module, thing = part("addon.inspection.cut_body"), soft_cube()
    mesh = part("operators.object.embedded_body").embedded(thing).mesh
    whole = module.below(mesh.nodes, mesh.tets, 0, 1.0)
    assert len(whole) == len(mesh.tets)
    left = module.below(mesh.nodes, mesh.tets, 0, 0.5)
    assert 0 < len(left) < len(whole)
    shown = left[module.outermost(mesh.tets[left])]
    assert 0 < len(shown) <= len(left)

    faces = module.faces_of(mesh.nodes, mesh.tets[shown])
    assert faces.shape == (4 * len(shown), 3, 3)
    middle = np.repeat(mesh.nodes[mesh.tets[shown]].mean(axis=1), 4, axis=0)
    across = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    assert (np.einsum("fx,fx->f", across, faces.mean(axis=1) - middle) > 0.0).all()


def shape_of(thing):
    shape = bmesh.new()
    shape.from_mesh(thing.data)
    return shape


def test_a_closed_mesh_has_no_problem(palpate):
    thing = cube()
    found = part("operators.bake.show_problems").problems_of(shape_of(thing))
    assert found.count == 0
    assert bpy.ops.palpate.show_problems() == {"FINISHED"}
    assert thing.mode == "OBJECT"


def test_holes_loose_vertices_and_crossing_faces_are_selected(palpate):
    corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    box = [(0, 2, 3, 1), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    # Open on top, a triangle through a side, and a vertex alone.
    blade = [(0.5, 0.5, 0.5), (1.5, 0.4, 0.5), (1.5, 0.6, 0.5)]
    thing = mesh_object([*corners, *blade, (3, 3, 3)], [*box, (8, 9, 10)])
    found = part("operators.bake.show_problems").problems_of(shape_of(thing))
    assert len(found.open_edges) == 4 + 3
    assert found.loose_vertices == {11}
    assert found.crossing_faces == {2, 5}
    assert not found.crowded_edges
    assert bpy.ops.palpate.show_problems() == {"FINISHED"}
    assert thing.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert thing.data.vertices[11].select
    assert [face.index for face in thing.data.polygons if face.select] == [2, 5]


def test_edges_of_three_faces_are_found(palpate):
    thing = mesh_object(
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, -1, 0)], [(0, 1, 2), (0, 1, 3), (0, 1, 4)]
    )
    found = part("operators.bake.show_problems").problems_of(shape_of(thing))
    assert len(found.crowded_edges) == 1


def test_a_refused_mesh_is_said_in_the_panel_with_a_button_that_shows_why(palpate):
    panel = part("addon.panels.sidebar").PALPATE_PT_main
    sheet = mesh_object([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    part("core.machine.machine_speed").dgemm_rate(1)
    assert error_of(bpy.ops.palpate.make_soft)
    shown = drawn(panel, select(sheet))
    assert "palpate.show_problems" in shown.operators
    assert "ERROR" in shown.icons
    assert "palpate.show_problems" not in drawn(panel, cube()).operators


def test_a_mesh_too_coarse_for_its_dents_is_told_so(palpate):
    panel = part("addon.panels.sidebar").PALPATE_PT_main
    thing = soft_cube()
    thing.palpate.free_surface_count = 73
    assert "Only 8 vertices are drawn" in drawn(panel, thing).text
    thing.palpate.free_surface_count = 8
    assert "vertices are drawn" not in drawn(panel, thing).text


def changes(*things):
    """What Blender would report of geometry that has changed."""
    updates = [
        SimpleNamespace(id=SimpleNamespace(original=thing), is_updated_geometry=True)
        for thing in things
    ]
    return SimpleNamespace(updates=updates)


def test_pins_are_computed_again_for_changes_of_their_own_mesh_alone(palpate, monkeypatch):
    module = part("addon.inspection.body_view")
    thing, other = cube(), mesh_object([(0, 0, 0)], [], "Other")
    which = (thing.session_uid, thing.data.session_uid)
    known = {"pins": (which, (np.zeros((0, 3, 3)), np.zeros((0, 3))))}
    monkeypatch.setattr(module, "_known", known)
    module.changed(changes(other, other.data))
    assert known
    module.changed(changes(thing.data))
    assert not known


def test_a_mesh_without_vertices_has_no_pins_to_show(palpate):
    select(mesh_object([], [], "Empty"))
    faces, _ = part("addon.inspection.body_view")._pins(bpy.context)
    assert len(faces) == 0


def test_a_keyed_mesh_with_more_vertices_drawn_is_measured_as_it_is_seen(palpate):
    thing = cube(0.05)
    thing.palpate.bake_from = "AUTO"
    thing.shape_key_add(name="Basis")
    wide = thing.shape_key_add(name="Wide")
    for point in wide.data:
        point.co.x *= 3.0
    wide.value = 1.0
    thing.modifiers.new("Two", "ARRAY").relative_offset_displace = (0.0, 2.0, 0.0)
    look = part("operators.object.mesh_look").MeshLook.take(thing, bpy.context.scene)
    assert len(look.own.local) == 8
    assert np.ptp(look.own.local[:, 0]) == pytest.approx(0.05, rel=1e-6)
    assert len(look.baked.local) == 16
    assert np.ptp(look.baked.local[:, 0]) == pytest.approx(0.15, rel=1e-6)
